#include "bus/request_check.h"

#include <algorithm>
#include <array>

#include "idl/values/limits.h"

namespace plab::bus
{
namespace
{

/// A lead byte of UTF-8: how many bytes follow, and the valid range of the first of them.
struct Lead
{
    unsigned char first, last;
    std::size_t follow;
    unsigned char next_least, next_most;
};
constexpr std::array<Lead, 9> kLeads{{
    {0x00, 0x7f, 0, 0, 0},
    {0xc2, 0xdf, 1, 0x80, 0xbf},
    {0xe0, 0xe0, 2, 0xa0, 0xbf},
    {0xe1, 0xec, 2, 0x80, 0xbf},
    {0xed, 0xed, 2, 0x80, 0x9f},
    {0xee, 0xef, 2, 0x80, 0xbf},
    {0xf0, 0xf0, 3, 0x90, 0xbf},
    {0xf1, 0xf3, 3, 0x80, 0xbf},
    {0xf4, 0xf4, 3, 0x80, 0x8f},
}};

/// Length in bytes of the character at the start of `text`; 0 if it is invalid.
std::size_t character_length(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const auto lead = std::find_if(kLeads.begin(), kLeads.end(), [&](const Lead& l) { return l.first <= byte(0) && byte(0) <= l.last; });
    if (lead == kLeads.end() || text.size() <= lead->follow) return 0;
    if (lead->follow > 0 && (byte(1) < lead->next_least || byte(1) > lead->next_most)) return 0;
    for (std::size_t i = 2; i <= lead->follow; ++i)
        if (byte(i) < 0x80 || byte(i) > 0xbf) return 0;
    return lead->follow + 1;
}

}  // namespace

bool is_utf8(std::string_view text)
{
    while (!text.empty())
    {
        const std::size_t length = character_length(text);
        if (length == 0) return false;
        text.remove_prefix(length);
    }
    return true;
}

std::string wrong_form(const RequestForm& form)
{
    if (std::all_of(form.client.begin(), form.client.end(), [](std::uint8_t byte) { return byte == 0; }))
        return "the request has no client id: use 16 random bytes";
    if (form.number == 0) return "the request has number 0: the first one of a client is 1";
    if (form.at < -1) return "the request is for step " + std::to_string(form.at) + ": steps count from 0, and -1 is the next one";
    if (form.revision < -1)
        return "the request is for revision " + std::to_string(form.revision) + ": revisions count from 0, and -1 is any";
    if (form.operations == 0) return "the request has no operation";
    if (form.operations > wire::kMostOperations)
        return "the request has " + std::to_string(form.operations) + " operations: at most " + std::to_string(wire::kMostOperations) +
               " are allowed";
    return {};
}

std::string wrong_count(std::size_t operation, std::size_t values)
{
    if (values <= wire::kMostValues) return {};
    return "operation " + std::to_string(operation + 1) + " has " + std::to_string(values) + " values: at most " +
           std::to_string(wire::kMostValues) + " are allowed";
}

std::string TextBudget::wrong(std::string_view text, const char* what)
{
    if (text.size() >= left_) return "the request has more than " + std::to_string(wire::kMostRequestBytes) + " bytes of text";
    left_ -= text.size() + 1;
    return is_utf8(text) ? std::string() : std::string(what) + " is not UTF-8";
}

std::string wrong_with(const wire::Request& request)
{
    std::string wrong = wrong_form({request.client, request.number, request.at, request.revision, request.operations.size()});
    for (std::size_t i = 0; i < request.operations.size() && wrong.empty(); ++i)
        wrong = wrong_count(i, request.operations[i].values.size());
    TextBudget budget;
    const auto check = [&](const std::string& text, const char* what)
    {
        if (wrong.empty()) wrong = budget.wrong(text, what);
    };
    for (const wire::Operation& op : request.operations)
    {
        check(op.verb, "a verb"), check(op.target, "a target"), check(op.argument, "an argument"), check(op.blueprint, "a blueprint");
        for (const auto& [name, text] : op.values) check(name, "a name"), check(text, "a value");
    }
    return wrong;
}

std::size_t bytes_of(const wire::Request& request)
{
    constexpr std::size_t kEachText = 32;
    std::size_t bytes = 0;
    for (const wire::Operation& operation : request.operations)
    {
        bytes += operation.verb.size() + operation.target.size() + operation.argument.size() + operation.blueprint.size() + 4 * kEachText;
        for (const auto& [name, text] : operation.values) bytes += name.size() + text.size() + 2 * kEachText;
    }
    return bytes;
}

bool is_shutdown(const wire::Request& request)
{
    if (request.operations.size() != 1) return false;
    const wire::Operation& only = request.operations[0];
    return only.verb == "shutdown" && only.target.empty() && only.argument.empty() && only.blueprint.empty() && only.values.empty();
}

}  // namespace plab::bus
