/// Where lines go: standard output or a file.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "plab/result.h"

namespace plab::logger
{

class Output
{
public:
    enum class State : unsigned char
    {
        Good,
        Closed,  ///< the reader of the pipe has gone: a normal end
        Broken,
    };

    /// Appends to `file`; empty: standard output.
    static Result<Output> open(const std::string& file);

    void write(const std::string& line);
    State flush();
    /// Why it is broken.
    const std::string& why() const { return why_; }

private:
    struct Closer
    {
        void operator()(std::FILE* f) const { (void)std::fclose(f); }
    };
    void note_error();

    std::unique_ptr<std::FILE, Closer> file_;  ///< empty: standard output
    State state_ = State::Good;
    std::string name_, why_;
};

}  // namespace plab::logger
