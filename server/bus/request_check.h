/// Checks the form of a request. Its meaning is checked elsewhere (server/control).
#pragma once

#include <string>
#include <string_view>

#include "idl/values/limits.h"
#include "publish/records.h"

namespace plab::bus
{

/// UTF-8 as RFC 3629 has it: no overlong forms, no surrogates, nothing above U+10FFFF.
bool is_utf8(std::string_view text);

/// How the limit on the text of all waiting requests counts: each text costs 32 bytes more than its length, roughly its memory
/// overhead, so that the limit also bounds the number of empty texts.
std::size_t bytes_of(const wire::Request& request);

/// Whether the request consists of one shutdown operation and nothing else.
bool is_shutdown(const wire::Request& request);

/// A request without its text.
struct RequestForm
{
    wire::ClientId client{};
    std::uint64_t number = 0;
    std::int64_t at = -1, revision = -1;
    std::size_t operations = 0;
};
/// The error; empty: none.
std::string wrong_form(const RequestForm& form);
/// The same for the number of values of an operation. Checked before each value's name is compared with all others, which takes
/// quadratic time.
std::string wrong_count(std::size_t operation, std::size_t values);

/// Text of one request, up to the limit. Each text costs one byte more than its length, so that the number of texts is limited
/// too.
class TextBudget
{
public:
    std::size_t left() const { return left_; }
    /// The error in the next text; empty: none.
    std::string wrong(std::string_view text, const char* what);

private:
    std::size_t left_ = wire::kMostRequestBytes;
};

/// All of these checks, for a request whose text has been copied elsewhere.
std::string wrong_with(const wire::Request& request);

}  // namespace plab::bus
