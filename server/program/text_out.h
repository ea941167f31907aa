/// The destination of text that a command produces: standard output or a file. The text is written to NAME.part, which gets its
/// final name when it is complete, and is removed otherwise.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "plab/result.h"

namespace plab::program
{

class TextOut
{
public:
    TextOut(TextOut&& other) noexcept = default;
    TextOut& operator=(TextOut&&) = delete;
    ~TextOut();

    /// "" or "-": standard output.
    static Result<TextOut> open(const std::string& path);

    void write(std::string_view text);
    /// The reader is gone (a closed pipe), or the disk is full: the rest need not be produced.
    bool is_over() const { return error_ != 0; }
    /// Writes what is left, and gives the file its name. A closed pipe is a normal end.
    Result<void> finish();

private:
    TextOut() = default;
    struct Closer
    {
        void operator()(std::FILE* file) const { (void)std::fclose(file); }
    };

    std::unique_ptr<std::FILE, Closer> file_;  ///< empty: standard output
    std::string name_;                         ///< for messages
    std::string target_;                       ///< the target after resolving links
    std::string partial_;  ///< "": written in place, because it is not a regular file (a pipe, a device) or standard output
    int error_ = 0;        ///< errno of the first failure
};

/// Writes one text as one file.
Result<void> write_file(const std::string& path, std::string_view text);

}  // namespace plab::program
