/// What a request must be before anybody looks at what it asks for. Sense is judged elsewhere, form here.
#pragma once

#include <string>
#include <string_view>

#include "idl/limits.h"
#include "publish/records.h"

namespace plab::bus
{

/// UTF-8 as RFC 3629 has it: no overlong forms, no surrogates, nothing above U+10FFFF.
bool is_utf8(std::string_view text);

/// What the limit on the text of all waiting requests counts: each text costs 32 bytes more than it has, about what it
/// takes to keep it, so that the limit bounds the number of empty ones too.
std::size_t bytes_of(const publish::RequestText& request);

/// One operation, and that is to end the server, and no more is said.
bool is_shutdown(const publish::RequestText& request);

/// A request without its text.
struct RequestForm
{
    publish::ClientId client{};
    std::uint64_t number = 0;
    std::int64_t at = -1, revision = -1;
    std::size_t operations = 0;
};
/// What is wrong with it; empty: nothing.
std::string wrong_form(const RequestForm& form);
/// The same of the number of values of an operation, before anybody compares each value's name with the others'.
std::string wrong_count(std::size_t operation, std::size_t values);

/// Text of one request, up to the limit. Each text costs a byte more than it has, so that its number is limited too.
class TextBudget
{
public:
    std::size_t left() const { return left_; }
    /// What is wrong with the next text; empty: nothing.
    std::string wrong(std::string_view text, const char* what);

private:
    std::size_t left_ = wire::kMostRequestBytes;
};

/// All of that, for a request whose text somebody else has copied.
std::string wrong_with(const publish::RequestText& request);

}  // namespace plab::bus
