#include "recordings/text_out.h"

#include <cerrno>
#include <cstring>

namespace plab::recordings
{

Result<TextOut> TextOut::open(const std::string& path)
{
    TextOut out;
    out.name_ = path.empty() || path == "-" ? "standard output" : path;
    if (path.empty() || path == "-") return out;
    out.file_.reset(std::fopen(path.c_str(), "we"));
    if (out.file_ == nullptr) return reason("cannot write " + path + ": " + std::strerror(errno));
    return out;
}

void TextOut::write(std::string_view text)
{
    if (is_over()) return;
    std::FILE* const to = file_ ? file_.get() : stdout;
    if (std::fwrite(text.data(), 1, text.size(), to) != text.size()) error_ = errno;
}

Result<void> TextOut::finish()
{
    if (!is_over() && std::fflush(file_ ? file_.get() : stdout) != 0) error_ = errno;
    if (error_ == 0 || error_ == EPIPE) return {};
    return reason("cannot write " + name_ + ": " + std::strerror(error_));
}

Result<void> write_file(const std::string& path, std::string_view text)
{
    auto out = TextOut::open(path);
    if (!out) return out.errors();
    out->write(text);
    return out->finish();
}

}  // namespace plab::recordings
