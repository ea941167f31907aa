#include "foxglove/protocol.h"

#include <doctest/doctest.h>

#include <cstring>
#include <nlohmann/json.hpp>

using namespace plab;
using namespace plab::foxglove;

namespace
{

std::string text_error(const std::string& text)
{
    const auto said = parse_said(text, false);
    return said ? "" : said.error().text();
}

template <class T>
void append(std::string& out, T value)
{
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string control_bytes(std::uint8_t command, float speed, std::uint8_t seeks, std::uint64_t time, const std::string& id)
{
    std::string out = "\3";
    append(out, command), append(out, speed), append(out, seeks), append(out, time);
    append(out, static_cast<std::uint32_t>(id.size()));
    return out + id;
}

}  // namespace

TEST_CASE("what clients say is understood")
{
    const auto subscribe =
        parse_said(R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":4294967295,"channelId":1}]})", false);
    REQUIRE(subscribe.ok());
    CHECK(std::get<Subscribe>(*subscribe).subscriptions.at(1).first == 4294967295u);
    CHECK(std::get<Unsubscribe>(*parse_said(R"({"op":"unsubscribe","subscriptionIds":[7]})", false)).subscriptions.at(0) == 7);
    const auto get = parse_said(R"({"op":"getParameters","parameterNames":["a.b"],"id":"x"})", false);
    CHECK(std::get<GetParameters>(*get).id == "x");
    const auto set = parse_said(
        R"({"op":"setParameters","parameters":[{"name":"a.b","value":0.1},{"name":"a.c","value":[1,2.5,-3]},{"name":"a.d","value":true}]})",
        false);
    REQUIRE(set.ok());
    const auto& values = std::get<SetParameters>(*set).values;
    CHECK(values.at(0).text == "0.1");
    CHECK(values.at(1).text == "1 2.5 -3");
    CHECK(values.at(2).text == "true");
    CHECK(!std::get<WatchParameters>(*parse_said(R"({"op":"unsubscribeParameterUpdates","parameterNames":[]})", false)).watches);
    std::string call = "\2";
    append(call, std::uint32_t{5}), append(call, std::uint32_t{9}), append(call, std::uint32_t{4});
    const auto service = parse_said(call + "json{}", true);
    REQUIRE(service.ok());
    CHECK(std::get<ServiceCall>(*service).service == 5);
    CHECK(std::get<ServiceCall>(*service).call == 9);
    CHECK(std::get<ServiceCall>(*service).data == "{}");
    const auto control = parse_said(control_bytes(0, 2, 1, 1'500'000'000, "r1"), true);
    REQUIRE(control.ok());
    CHECK(std::get<PlaybackControl>(*control).plays);
    CHECK(std::get<PlaybackControl>(*control).seek == 1'500'000'000u);
    CHECK(std::get<PlaybackControl>(*control).request == "r1");
    CHECK(!std::get<PlaybackControl>(*parse_said(control_bytes(1, 1, 0, 77, "r"), true)).seek);
}

TEST_CASE("what cannot be understood is refused with a reason")
{
    CHECK(text_error("") == "the message is no JSON object");
    CHECK(text_error("[1]") == "the message is no JSON object");
    CHECK(text_error("{}") == "'op' must be the name of an operation");
    CHECK(text_error(R"({"op":"advertise","channels":[]})") == "'advertise' is not offered here");
    for (const char* text :
         {R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
          R"({"op":"subscribe","subscriptions":[1]})", R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})",
          R"({"op":"unsubscribe","subscriptionIds":["0"]})", R"({"op":"getParameters","parameterNames":[1]})",
          R"({"op":"getParameters","parameterNames":["a"],"id":7})", R"({"op":"setParameters","parameters":[{"name":"a.b"}]})",
          R"({"op":"setParameters","parameters":[{"name":"a.b","value":{"x":1}}]})",
          R"({"op":"setParameters","parameters":[{"name":"a.b","value":[[1]]}]})"})
    {
        INFO(text);
        CHECK(!text_error(text).empty());
    }
    std::string many = R"({"op":"unsubscribe","subscriptionIds":[0)";
    for (std::size_t i = 0; i < kMostNames; ++i) many += ",1";
    CHECK(!text_error(many + "]}").empty());
    // Binary messages, cut at every place.
    std::string call = "\2";
    append(call, std::uint32_t{5}), append(call, std::uint32_t{9}), append(call, std::uint32_t{4});
    call += "json";
    const std::string control = control_bytes(0, 1, 1, 5, "id");
    for (const std::string& whole : {call, control})
        for (std::size_t n = 0; n < whole.size(); ++n) CHECK(!parse_said(whole.substr(0, n), true).ok());
    std::string longer = "\2";
    append(longer, std::uint32_t{5}), append(longer, std::uint32_t{9}), append(longer, std::uint32_t{4000000000u});
    CHECK(!parse_said(longer + "json", true).ok());
    CHECK(!parse_said(control_bytes(2, 1, 0, 0, "x"), true).ok());
    CHECK(!parse_said(control_bytes(0, 0, 0, 0, "x"), true).ok());
    CHECK(!parse_said(control_bytes(0, NAN, 0, 0, "x"), true).ok());
    CHECK(!parse_said(std::string("\1\0\0\0\0", 5), true).ok());
}

TEST_CASE("every topic of the bus has a channel, whose schema has what its type needs and no more")
{
    CHECK(channels().size() == wire::topics().size() + 3);  // the scene, its frames, arrows of contacts
    const Channel& states = channel_of("plab/states");
    CHECK(states.schema_name == "plab::v2::Frame");
    CHECK(states.schema.find("struct BodyState") != std::string::npos);
    CHECK(states.schema.find("struct Request") == std::string::npos);
    CHECK(states.keep == Keep::Newest);
    CHECK(channel_of("plab/events").keep == Keep::Log);
    CHECK(find_channel(0) == nullptr);
    CHECK(find_channel(static_cast<ChannelId>(channels().size() + 1)) == nullptr);
    for (const Channel& c : channels()) CHECK(find_channel(c.id) == &c);
}

TEST_CASE("a playback has times, and its state is laid out as Foxglove reads it")
{
    const Json info = server_info({"n", "s", false, TimeRange{1'500'000'000, 4'000'000'001}});
    CHECK(info["dataStartTime"]["sec"] == 1);
    CHECK(info["dataStartTime"]["nsec"] == 500'000'000);
    CHECK(info["dataEndTime"]["nsec"] == 1);
    CHECK(info["capabilities"].dump().find("services") == std::string::npos);
    CHECK(!server_info({"n", "s", true, {}}).contains("dataStartTime"));
    const MessagePtr state = playback_state({PlaybackStatus::Ended, 258, 2, true, "ab"});
    const std::string bytes(reinterpret_cast<const char*>(state->content()), state->size());
    CHECK(bytes == std::string("\5\3\2\1\0\0\0\0\0\0\0\0\0\x40\1\2\0\0\0ab", 21));
}
