#include "program/text_out.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace plab::program
{

namespace fs = std::filesystem;

Result<TextOut> TextOut::open(const std::string& path)
{
    TextOut out;
    out.name_ = path.empty() || path == "-" ? "standard output" : path;
    if (path.empty() || path == "-") return out;
    std::error_code failed;
    const fs::path real = fs::weakly_canonical(path, failed);  // a link is kept: its target is written
    out.target_ = failed ? path : real.string();
    const auto kind = fs::status(out.target_, failed).type();
    if (kind == fs::file_type::regular || kind == fs::file_type::not_found)
    {
        out.partial_ = out.target_ + ".part";
        out.file_.reset(std::fopen(out.partial_.c_str(), "we"));
        if (out.file_ == nullptr) out.partial_.clear();  // the folder accepts no new file, but the file may exist
    }
    if (out.file_ == nullptr) out.file_.reset(std::fopen(path.c_str(), "we"));
    if (out.file_ == nullptr) return reason("cannot write " + path + ": " + std::strerror(errno));
    return out;
}

void TextOut::write(std::string_view text)
{
    if (is_over()) return;
    std::FILE* const to = file_ ? file_.get() : stdout;
    if (std::fwrite(text.data(), 1, text.size(), to) != text.size()) error_ = errno;
}

TextOut::~TextOut()
{
    if (file_ == nullptr || partial_.empty()) return;
    file_.reset();
    std::error_code ignored;
    (void)fs::remove(partial_, ignored);
}

Result<void> TextOut::finish()
{
    if (!is_over() && std::fflush(file_ ? file_.get() : stdout) != 0) error_ = errno;
    if (error_ == 0 && !partial_.empty())
    {
        if (std::rename(partial_.c_str(), target_.c_str()) == 0)
            partial_.clear();
        else
            error_ = errno;
    }
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

}  // namespace plab::program
