#include "bus/process/request_read.h"

#include <algorithm>
#include <cstring>

#include "bus/request_check.h"

namespace plab::bus
{
namespace
{

/// Copies text until the request's limit is used up, or a text is not UTF-8.
class TextReader
{
public:
    std::string copy(const char* source, const char* what)
    {
        if (!wrong_.empty() || source == nullptr) return {};
        const std::string_view text(source, strnlen(source, budget_.left()));
        wrong_ = budget_.wrong(text, what);
        return ok() ? std::string(text) : std::string();
    }
    bool ok() const { return wrong_.empty(); }
    const std::string& wrong() const { return wrong_; }

private:
    TextBudget budget_;
    std::string wrong_;
};

wire::Operation read_operation(const plab_v2_Operation& operation, TextReader& reader)
{
    wire::Operation out;
    out.verb = reader.copy(operation.verb, "a verb");
    out.target = reader.copy(operation.target, "a target");
    out.argument = reader.copy(operation.argument, "an argument");
    out.blueprint = reader.copy(operation.blueprint, "a blueprint");
    out.values.reserve(operation.values._length);
    for (std::uint32_t i = 0; i < operation.values._length && reader.ok(); ++i)
    {
        std::string name = reader.copy(operation.values._buffer[i].name, "a name");
        out.values.push_back({std::move(name), reader.copy(operation.values._buffer[i].text, "a value")});
    }
    return out;
}

std::string wrong_outside(const plab_v2_Request& request)
{
    std::string wrong = wrong_form({client_of(request), request.number, request.at, request.revision, request.operations._length});
    for (std::uint32_t i = 0; i < request.operations._length && wrong.empty(); ++i)
        wrong = wrong_count(i, request.operations._buffer[i].values._length);
    return wrong;
}

}  // namespace

wire::ClientId client_of(const plab_v2_Request& request)
{
    wire::ClientId client;
    static_assert(sizeof(request.client) == std::tuple_size_v<wire::ClientId>);
    std::copy(std::begin(request.client), std::end(request.client), client.begin());
    return client;
}

Result<wire::Request> read_request(const plab_v2_Request& request)
{
    if (std::string wrong = wrong_outside(request); !wrong.empty()) return reason(std::move(wrong));
    TextReader reader;
    wire::Request out;
    out.client = client_of(request), out.number = request.number, out.at = request.at, out.revision = request.revision;
    for (std::uint32_t i = 0; i < request.operations._length && reader.ok(); ++i)
        out.operations.push_back(read_operation(request.operations._buffer[i], reader));
    if (!reader.ok()) return reason(reader.wrong());
    return out;
}

}  // namespace plab::bus
