/// Where text goes that a command makes: standard output or a file, which is emptied first.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "plab/result.h"

namespace plab::recordings
{

class TextOut
{
public:
    /// "" or "-": standard output.
    static Result<TextOut> open(const std::string& path);

    void write(std::string_view text);
    /// Nobody reads any more (a closed pipe), or the disk is full: the rest need not be made.
    bool is_over() const { return error_ != 0; }
    /// Writes what is left. A closed pipe is a normal end.
    Result<void> finish();

private:
    struct Closer
    {
        void operator()(std::FILE* file) const { (void)std::fclose(file); }
    };

    std::unique_ptr<std::FILE, Closer> file_;  ///< empty: standard output
    std::string name_;
    int error_ = 0;  ///< errno of the first failure
};

/// One text as one file.
Result<void> write_file(const std::string& path, std::string_view text);

}  // namespace plab::recordings
