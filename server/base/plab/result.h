/// Errors as values. Bad input gives a Result that states the place, the element and the reason; nothing is thrown.
#pragma once

#include <cassert>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace plab
{

/// A place in a blueprint or a request: file (or "request 17"), line and column counted from 1; line 0: none.
struct SourceLocation
{
    std::string file;
    std::uint32_t line = 0;
    std::uint32_t column = 0;
};

/// One error. Its text reads "scene.xml:4:7: gear (Constraint/...): velocity_factor must not be zero".
struct Error
{
    SourceLocation where;
    std::string element;  ///< the component, command or element concerned; may be empty
    std::string reason;   ///< what is wrong, and what would be right

    std::string text() const
    {
        std::string out;
        if (!where.file.empty())
        {
            out += where.file + ":";
            if (where.line > 0) out += std::to_string(where.line) + ":" + std::to_string(where.column) + ":";
            out += " ";
        }
        if (!element.empty()) out += element + ": ";
        return out + reason;
    }
};

using Errors = std::vector<Error>;

/// A value, or the reasons why there is none.
template <class T>
class [[nodiscard]] Result
{
public:
    Result(T value) : state_(std::move(value)) {}                                           // NOLINT: implicit by design
    Result(Error error) : state_(Errors{std::move(error)}) {}                               // NOLINT
    Result(Errors errors) : state_(std::move(errors)) { assert(!this->errors().empty()); }  // NOLINT

    bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }
    const T& value() const
    {
        assert(ok());
        return std::get<0>(state_);
    }
    T& value()
    {
        assert(ok());
        return std::get<0>(state_);
    }
    const T& operator*() const { return value(); }
    T& operator*() { return value(); }
    const T* operator->() const { return &value(); }
    T* operator->() { return &value(); }
    T take()
    {
        assert(ok());
        return std::move(std::get<0>(state_));
    }
    const Errors& errors() const { return std::get<1>(state_); }
    const Error& error() const { return errors().front(); }

private:
    std::variant<T, Errors> state_;
};

/// Success, or the reasons for the failure.
template <>
class [[nodiscard]] Result<void>
{
public:
    Result() = default;
    Result(Error error) : errors_{std::move(error)} {}     // NOLINT
    Result(Errors errors) : errors_(std::move(errors)) {}  // NOLINT

    bool ok() const { return errors_.empty(); }
    explicit operator bool() const { return ok(); }
    const Errors& errors() const { return errors_; }
    const Error& error() const { return errors_.front(); }

private:
    Errors errors_;
};

/// An error that only states a reason; the caller adds place and element.
inline Error reason(std::string why) { return Error{{}, {}, std::move(why)}; }

}  // namespace plab
