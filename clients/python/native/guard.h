/// How errors of C++ become what functions of C return.
#pragma once

#include <exception>
#include <string>
#include <type_traits>

#include "plab/result.h"

namespace plab::python
{

/// Of this thread.
inline std::string& last_error()
{
    thread_local std::string text;
    return text;
}

/// All reasons, each on a line.
inline void set_error(const Errors& errors)
{
    last_error().clear();
    for (const Error& error : errors) last_error() += (last_error().empty() ? "" : "\n") + error.text();
}

/// What a function of C returns where it failed.
template <class T>
T failure()
{
    if constexpr (std::is_pointer_v<T>)
        return nullptr;
    else
        return T(-1);
}

/// Calls `work`, which returns a Result<T>; no exception passes (memory that ran out, JSON of a text that is no UTF-8).
template <class Work>
auto guarded(Work&& work)
{
    using T = std::remove_cvref_t<decltype(work().value())>;
    last_error().clear();
    try
    {
        auto result = work();
        if (result) return result.take();
        set_error(result.errors());
    }
    catch (const std::exception& error)
    {
        last_error() = error.what();
    }
    return failure<T>();
}

}  // namespace plab::python
