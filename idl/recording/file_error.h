/// System errors that concern a file.
#pragma once

#include <cerrno>
#include <string>
#include <system_error>

#include "plab/result.h"

namespace plab::recording
{

/// "run.mcap: cannot write: No space left on device", with the text of errno.
inline Error file_error(const std::string& path, const char* what)
{
    Error error = reason(std::string(what) + ": " + std::generic_category().message(errno));
    error.where.file = path;
    return error;
}

/// Repeats a call that a signal interrupted.
template <class Call>
auto uninterrupted(Call&& call)
{
    auto result = call();
    while (result < 0 && errno == EINTR) result = call();
    return result;
}

}  // namespace plab::recording
