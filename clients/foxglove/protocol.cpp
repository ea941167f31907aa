#include "foxglove/protocol.h"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "foxglove/value_text.h"

namespace plab::foxglove
{
namespace
{

enum class FromServer : std::uint8_t
{
    MessageData = 1,
    Time = 2,
    ServiceCallResponse = 3,
    PlaybackState = 5,
};
enum class FromClient : std::uint8_t
{
    MessageData = 1,
    ServiceCallRequest = 2,
    PlaybackControlRequest = 3,
};

class Writer
{
public:
    explicit Writer(FromServer op) { put(op); }
    template <class T>
    void put(T value)
    {
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        out_.append(bytes, sizeof value);
    }
    void put_text(const std::string& text)
    {
        put(static_cast<std::uint32_t>(text.size()));
        out_ += text;
    }
    void put_rest(const std::string& bytes) { out_ += bytes; }
    const std::string& bytes() const { return out_; }
    MessagePtr message() const { return std::make_shared<Message>(Message::binary(std::string_view(out_))); }

private:
    std::string out_;
};

/// Reads numbers and texts one behind the other; whatever is missing reads as zeros and makes it not ok().
class Reader
{
public:
    explicit Reader(const std::string& bytes) : bytes_(bytes) {}
    template <class T>
    T take()
    {
        T out{};
        if (bytes_.size() - at_ < sizeof out)
            ok_ = false;
        else
        {
            std::memcpy(&out, bytes_.data() + at_, sizeof out);
            at_ += sizeof out;
        }
        return out;
    }
    std::string take_text()
    {
        const auto size = take<std::uint32_t>();
        if (!ok_ || bytes_.size() - at_ < size)
        {
            ok_ = false;
            return {};
        }
        at_ += size;
        return bytes_.substr(at_ - size, size);
    }
    std::string take_rest() { return bytes_.substr(std::exchange(at_, bytes_.size())); }
    bool ok() const { return ok_; }

private:
    const std::string& bytes_;
    std::size_t at_ = 0;
    bool ok_ = true;
};

Json time_json(std::uint64_t time) { return {{"sec", time / 1'000'000'000u}, {"nsec", time % 1'000'000'000u}}; }

}  // namespace

MessagePtr text_message(const Json& json) { return std::make_shared<Message>(wire::line_of(json)); }

Json server_info(const Offer& offer)
{
    Json out{{"op", "serverInfo"}, {"name", offer.name}, {"capabilities", {"time", "parameters", "parametersSubscribe"}}};
    if (offer.writes) out["capabilities"].push_back("services"), out["supportedEncodings"] = {"json"};
    if (offer.playback)
    {
        out["capabilities"].push_back("playbackControl");
        out["dataStartTime"] = time_json(offer.playback->from), out["dataEndTime"] = time_json(offer.playback->to);
    }
    out["sessionId"] = offer.session;
    return out;
}

Json advertise_channels()
{
    Json list = Json::array();
    for (const Channel& c : channels())
        list.push_back({{"id", c.id},
                        {"topic", c.topic},
                        {"encoding", "cdr"},
                        {"schemaName", c.schema_name},
                        {"schemaEncoding", "omgidl"},
                        {"schema", c.schema}});
    return {{"op", "advertise"}, {"channels", std::move(list)}};
}

Json status(Level level, const std::string& sentence, const std::string& id)
{
    Json out{{"op", "status"}, {"level", static_cast<int>(level)}, {"message", sentence}};
    if (!id.empty()) out["id"] = id;
    return out;
}

Json remove_status(const std::string& id) { return {{"op", "removeStatus"}, {"statusIds", {id}}}; }

Json parameter_values(Json parameters, const std::string& id)
{
    Json out{{"op", "parameterValues"}, {"parameters", std::move(parameters)}};
    if (!id.empty()) out["id"] = id;
    return out;
}

Json service_failure(std::uint32_t service, std::uint32_t call, const std::string& sentence)
{
    return {{"op", "serviceCallFailure"}, {"serviceId", service}, {"callId", call}, {"message", sentence}};
}

MessagePtr service_response(std::uint32_t service, std::uint32_t call, const Json& reply)
{
    Writer out(FromServer::ServiceCallResponse);
    out.put(service), out.put(call), out.put_text("json");
    out.put_rest(wire::line_of(reply));
    return out.message();
}

MessagePtr time_message(std::uint64_t time)
{
    Writer out(FromServer::Time);
    out.put(time);
    return out.message();
}

void write_message_head(SubscriptionId subscription, std::uint64_t time, Outgoing& out)
{
    Writer head(FromServer::MessageData);
    head.put(subscription), head.put(time);
    out.head_size = head.bytes().size();
    static_assert(1 + sizeof subscription + sizeof time <= Outgoing::kMostHead);
    std::memcpy(out.head.data(), head.bytes().data(), out.head_size);
}

MessagePtr playback_state(const PlaybackState& state)
{
    Writer out(FromServer::PlaybackState);
    out.put(state.status), out.put(state.time), out.put(state.speed);
    out.put(static_cast<std::uint8_t>(state.did_seek ? 1 : 0));
    out.put_text(state.request);
    return out.message();
}

// ---- From clients ---------------------------------------------------------------------------------------------------

namespace
{

/// The member `name`: a list of at most kMostNames values that `read` takes; it returns false for what is no such value.
template <class Read>
Result<void> read_list(const Json& json, const char* name, const char* what, const Read& read)
{
    const auto at = json.find(name);
    const Error wrong = reason(std::string("'") + name + "' must be a list of at most " + std::to_string(kMostNames) + " " + what);
    if (at == json.end() || !at->is_array() || at->size() > kMostNames) return wrong;
    for (const Json& one : *at)
        if (!read(one)) return wrong;
    return {};
}

std::optional<std::uint32_t> number_of(const Json& json)
{
    if (!json.is_number_unsigned() || json.get<std::uint64_t>() > UINT32_MAX) return {};
    return json.get<std::uint32_t>();
}

std::optional<std::uint32_t> number_of(const Json& json, const char* name)
{
    if (!json.is_object()) return {};
    const auto at = json.find(name);
    return at == json.end() ? std::nullopt : number_of(*at);
}

Result<std::vector<std::string>> names_in(const Json& json)
{
    std::vector<std::string> out;
    const auto read = [&](const Json& one)
    {
        if (!one.is_string()) return false;
        out.push_back(one.get<std::string>());
        return true;
    };
    if (auto done = read_list(json, "parameterNames", "names", read); !done) return done.errors();
    return out;
}

Result<std::string> id_of(const Json& json)
{
    const auto at = json.find("id");
    if (at == json.end()) return std::string();
    if (!at->is_string()) return reason("'id' must be a text");
    return at->get<std::string>();
}

Result<Said> parse_subscribe(const Json& json)
{
    Subscribe out;
    const auto read = [&](const Json& one)
    {
        const auto id = number_of(one, "id"), channel = number_of(one, "channelId");
        if (id && channel) out.subscriptions.emplace_back(*id, *channel);
        return id && channel;
    };
    if (auto done = read_list(json, "subscriptions", "objects with the whole numbers 'id' and 'channelId'", read); !done)
        return done.errors();
    return Said{std::move(out)};
}

Result<Said> parse_unsubscribe(const Json& json)
{
    Unsubscribe out;
    const auto read = [&](const Json& one)
    {
        const auto id = number_of(one);
        if (id) out.subscriptions.push_back(*id);
        return id.has_value();
    };
    if (auto done = read_list(json, "subscriptionIds", "whole numbers", read); !done) return done.errors();
    return Said{std::move(out)};
}

Result<Said> parse_get(const Json& json)
{
    auto names = names_in(json);
    if (!names) return names.errors();
    auto id = id_of(json);
    if (!id) return id.errors();
    return Said{GetParameters{names.take(), id.take()}};
}

Result<Said> parse_set(const Json& json)
{
    SetParameters out;
    const auto read = [&](const Json& one)
    {
        if (!one.is_object() || !one.contains("name") || !one["name"].is_string() || !one.contains("value")) return false;
        auto text = value_text(one["value"]);
        if (text) out.values.push_back({one["name"].get<std::string>(), std::move(*text)});
        return text.has_value();
    };
    constexpr const char* kWhat = "objects with 'name' and 'value': a text, a number, true, false or a list of numbers";
    if (auto done = read_list(json, "parameters", kWhat, read); !done) return done.errors();
    auto id = id_of(json);
    if (!id) return id.errors();
    out.id = id.take();
    return Said{std::move(out)};
}

Result<Said> parse_watch(const Json& json, bool watches)
{
    auto names = names_in(json);
    if (!names) return names.errors();
    return Said{WatchParameters{names.take(), watches}};
}

Result<Said> parse_text(const std::string& text)
{
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) return reason("the message is no JSON object");
    const auto at = json.find("op");
    const std::string op = at != json.end() && at->is_string() ? at->get<std::string>() : "";
    if (op == "subscribe") return parse_subscribe(json);
    if (op == "unsubscribe") return parse_unsubscribe(json);
    if (op == "getParameters") return parse_get(json);
    if (op == "setParameters") return parse_set(json);
    if (op == "subscribeParameterUpdates" || op == "unsubscribeParameterUpdates") return parse_watch(json, op.starts_with('s'));
    return reason(op.empty() ? "'op' must be the name of an operation" : "'" + op + "' is not offered here");
}

Result<Said> parse_service_call(Reader& reader)
{
    ServiceCall out;
    out.service = reader.take<std::uint32_t>(), out.call = reader.take<std::uint32_t>();
    out.encoding = reader.take_text();
    if (!reader.ok()) return reason("the call of a service ends too early");
    out.data = reader.take_rest();
    return Said{std::move(out)};
}

Result<Said> parse_playback(Reader& reader)
{
    PlaybackControl out;
    const auto command = reader.take<std::uint8_t>();
    out.plays = command == 0;
    out.speed = reader.take<float>();
    const bool seeks = reader.take<std::uint8_t>() != 0;
    const auto time = reader.take<std::uint64_t>();
    if (seeks) out.seek = time;
    out.request = reader.take_text();
    if (!reader.ok()) return reason("the control of a playback ends too early");
    if (command > 1) return reason("a playback has the commands 0 (play) and 1 (pause), not " + std::to_string(command));
    if (!std::isfinite(out.speed) || out.speed <= 0) return reason("the speed of a playback must be more than 0");
    return Said{std::move(out)};
}

}  // namespace

Result<Said> parse_said(const std::string& bytes, bool is_binary)
{
    if (!is_binary) return parse_text(bytes);
    Reader reader(bytes);
    const auto op = reader.take<FromClient>();
    if (op == FromClient::ServiceCallRequest) return parse_service_call(reader);
    if (op == FromClient::PlaybackControlRequest) return parse_playback(reader);
    return reason("binary messages must begin with 2 (call of a service) or 3 (control of a playback)");
}

}  // namespace plab::foxglove
