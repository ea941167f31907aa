#include "logger/output.h"

#include <cerrno>
#include <cstring>

namespace plab::logger
{

Result<Output> Output::open(const std::string& file)
{
    Output out;
    out.name_ = file.empty() ? "standard output" : "'" + file + "'";
    if (file.empty()) return out;
    out.file_.reset(std::fopen(file.c_str(), "ae"));
    if (out.file_ == nullptr) return reason("cannot write " + out.name_ + ": " + std::strerror(errno));
    return out;
}

void Output::note_error()
{
    if (state_ != State::Good) return;
    state_ = errno == EPIPE ? State::Closed : State::Broken;
    why_ = "cannot write " + name_ + ": " + std::strerror(errno);
}

void Output::write(const std::string& line)
{
    std::FILE* const to = file_ ? file_.get() : stdout;
    if (std::fwrite(line.data(), 1, line.size(), to) != line.size() || std::fputc('\n', to) == EOF) note_error();
}

Output::State Output::flush()
{
    if (std::fflush(file_ ? file_.get() : stdout) != 0) note_error();
    return state_;
}

}  // namespace plab::logger
