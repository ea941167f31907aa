#include "bus/request_check.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "idl/topics.h"

namespace plab::bus
{
namespace
{

/// Copies text until the request's limit is used up or one is not UTF-8. Each text costs a byte more than it has, so
/// that the limit bounds their number too.
class TextReader
{
public:
    std::string copy(const char* source, const char* what)
    {
        if (!wrong_.empty() || source == nullptr) return {};
        const std::size_t length = strnlen(source, left_);
        if (length == left_)
        {
            wrong_ = "the request has more than " + std::to_string(wire::kMostRequestBytes) + " bytes of text";
            return {};
        }
        left_ -= length + 1;
        if (!is_utf8({source, length})) wrong_ = std::string(what) + " is not UTF-8";
        return {source, length};
    }
    bool ok() const { return wrong_.empty(); }
    const std::string& wrong() const { return wrong_; }

private:
    std::size_t left_ = wire::kMostRequestBytes;
    std::string wrong_;
};

publish::OperationText read_operation(const plab_v2_Operation& operation, TextReader& reader)
{
    publish::OperationText out;
    out.verb = reader.copy(operation.verb, "a verb");
    out.target = reader.copy(operation.target, "a target");
    out.argument = reader.copy(operation.argument, "an argument");
    out.blueprint = reader.copy(operation.blueprint, "a blueprint");
    out.values.reserve(operation.values._length);
    for (std::uint32_t i = 0; i < operation.values._length && reader.ok(); ++i)
    {
        std::string name = reader.copy(operation.values._buffer[i].name, "a name");
        out.values.emplace_back(std::move(name), reader.copy(operation.values._buffer[i].text, "a value"));
    }
    return out;
}

std::string wrong_outside(const plab_v2_Request& request)
{
    const publish::ClientId client = client_of(request);
    if (std::all_of(client.begin(), client.end(), [](std::uint8_t byte) { return byte == 0; }))
        return "the request has no client id: 16 random bytes are right";
    if (request.number == 0) return "the request has number 0: the first one of a client is 1";
    if (request.at < -1) return "the request is for step " + std::to_string(request.at) + ": steps count from 0, and -1 is the next one";
    if (request.revision < -1)
        return "the request is for revision " + std::to_string(request.revision) + ": revisions count from 0, and -1 is any";
    if (request.operations._length == 0) return "the request has no operation";
    if (request.operations._length > wire::kMostOperations)
        return "the request has " + std::to_string(request.operations._length) + " operations: at most " +
               std::to_string(wire::kMostOperations) + " may be asked for at once";
    // Before anybody compares each value's name with the others'.
    for (std::uint32_t i = 0; i < request.operations._length; ++i)
        if (const std::uint32_t values = request.operations._buffer[i].values._length; values > wire::kMostValues)
            return "operation " + std::to_string(i + 1) + " has " + std::to_string(values) + " values: at most " +
                   std::to_string(wire::kMostValues) + " may be given at once";
    return {};
}

/// A lead byte of UTF-8: how many bytes follow, and what the first of them may be.
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

/// Bytes of the character at the start of `text`, 0 if it is none.
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

publish::ClientId client_of(const plab_v2_Request& request)
{
    publish::ClientId client;
    static_assert(sizeof(request.client) == std::tuple_size_v<publish::ClientId>);
    std::copy(std::begin(request.client), std::end(request.client), client.begin());
    return client;
}

std::size_t bytes_of(const publish::RequestText& request)
{
    constexpr std::size_t kEachText = 32;
    std::size_t bytes = 0;
    for (const publish::OperationText& operation : request.operations)
    {
        bytes += operation.verb.size() + operation.target.size() + operation.argument.size() + operation.blueprint.size() + 4 * kEachText;
        for (const auto& [name, text] : operation.values) bytes += name.size() + text.size() + 2 * kEachText;
    }
    return bytes;
}

bool is_shutdown(const publish::RequestText& request)
{
    if (request.operations.size() != 1) return false;
    const publish::OperationText& only = request.operations[0];
    return only.verb == "shutdown" && only.target.empty() && only.argument.empty() && only.blueprint.empty() && only.values.empty();
}

Result<publish::RequestText> read_request(const plab_v2_Request& request)
{
    if (std::string wrong = wrong_outside(request); !wrong.empty()) return reason(std::move(wrong));
    TextReader reader;
    publish::RequestText out;
    out.client = client_of(request), out.number = request.number, out.at = request.at, out.revision = request.revision;
    for (std::uint32_t i = 0; i < request.operations._length && reader.ok(); ++i)
        out.operations.push_back(read_operation(request.operations._buffer[i], reader));
    if (!reader.ok()) return reason(reader.wrong());
    return out;
}

}  // namespace plab::bus
