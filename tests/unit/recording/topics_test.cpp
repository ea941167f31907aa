// pLab's own topics: self-contained schemas, samples as bytes and back, bytes that are not samples.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "idl/recording/cdr.h"
#include "idl/recording/topic_file.h"
#include "sample_file.h"

using namespace plab::recording;
using namespace plab::recording::test;

namespace
{

plab_v2_BodyState body(double x) { return {7, {x, 2, 3}, {1, 0, 0, 0}, {4, 5, 6}, {-1, -2, -3}}; }

/// A frame of `n` bodies, in memory of the caller's.
plab_v2_Frame frame_of(std::vector<plab_v2_BodyState>& bodies, std::size_t n)
{
    bodies.clear();
    for (std::size_t i = 0; i < n; ++i) bodies.push_back(body(static_cast<double>(i)));
    plab_v2_Frame frame{};
    frame.run = 3;
    frame.step = -5;
    frame.time = 0.1;
    const auto count = static_cast<std::uint32_t>(n);
    frame.bodies = {count, count, bodies.data(), false};
    return frame;
}

Bytes copy_of(ByteView bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

TEST_CASE("each topic has a schema with all types that its type needs, and no others")
{
    for (const plab::wire::Topic& topic : plab::wire::topics())
    {
        CAPTURE(topic.name);
        auto schema = schema_of(topic);
        REQUIRE(schema);
        CHECK(schema->name == topic.type->m_typename);
        CHECK(schema->encoding == "omgidl");
        const std::string& idl = schema->data;
        CHECK(idl.starts_with("module plab {\nmodule v2 {\n"));
        CHECK(idl.ends_with("};\n};\n"));
        CHECK(idl.find("//") == std::string::npos);
        CHECK(std::ranges::count(idl, '{') == std::ranges::count(idl, '}'));
        const Channel channel = channel_of(topic, 3);
        CHECK(channel.topic == topic.name);
        CHECK(channel.message_encoding == "cdr");
    }
    CHECK(*idl_of("plab::v2::Collisions") ==
          "module plab {\nmodule v2 {\n"
          "@final @nested struct Vector { double x; double y; double z; };\n"
          "@final @nested struct CollisionInfo { string kind; double time; string detector; string a; string b; Vector position; "
          "Vector normal; Vector impulse; double depth; };\n"
          "@final struct Collisions { unsigned long long run; unsigned long long sequence_number; long long step; "
          "sequence<CollisionInfo> entries; };\n"
          "};\n};\n");
    CHECK(idl_of("plab::v2::Request")->find("typedef octet ClientId[16];") != std::string::npos);
    CHECK(idl_of("plab::v2::Nothing").error().text() == "the IDL declares no plab::v2::Nothing");
    CHECK(!idl_of("other::v2::Frame"));
    CHECK(!select_idl("", "plab::v2::Frame"));
}

TEST_CASE("a frame as bytes and back")
{
    std::vector<plab_v2_BodyState> bodies;
    const plab_v2_Frame frame = frame_of(bodies, 100);
    Encoder encoder;
    const Bytes bytes = copy_of(*encoder.encode(frame));
    // Encapsulation, six numbers, a length and the first handle, all else of the bodies with 4 bytes of padding each, a length.
    CHECK(bytes.size() == 4 + 48 + 8 + 100 * (13 * 8) + 99 * 8 + 4);
    CHECK(Bytes(bytes.begin(), bytes.begin() + 4) == Bytes{0, 1, 0, 0});
    Decoder decoder;
    Sample<plab_v2_Frame> back;
    REQUIRE(decoder.decode(bytes, back));
    CHECK(back->step == -5);
    CHECK(back->time == 0.1);
    REQUIRE(back->bodies._length == 100);
    CHECK(back->bodies._buffer[99].position.x == 99);
    CHECK(back->bodies._buffer[99].angular_velocity.z == -3);
    CHECK(copy_of(*encoder.encode(*back)) == bytes);
    // The sample is used again, for more and for fewer bodies.
    for (const std::size_t n : {300u, 2u, 0u})
    {
        REQUIRE(decoder.decode(*encoder.encode(frame_of(bodies, n)), back));
        CHECK(back->bodies._length == n);
    }
}

TEST_CASE("texts and keys as bytes and back, in both byte orders and with padding")
{
    plab_v2_EventInfo info{};
    char kind[] = "script.print", message[] = "hello";
    info.kind = kind;
    info.message = message;
    plab_v2_Events events{};
    events.entries = {1, 1, &info, false};
    Encoder encoder;
    Bytes bytes = copy_of(*encoder.encode(events));
    Decoder decoder;
    Sample<plab_v2_Events> back;
    REQUIRE(decoder.decode(bytes, back));
    CHECK(std::string(back->entries._buffer[0].kind) == "script.print");
    CHECK(std::string(back->entries._buffer[0].message) == "hello");
    CHECK(std::string(back->entries._buffer[0].severity).empty());
    bytes.push_back(0);
    CHECK(decoder.decode(bytes, back).error().text() == "plab::v2::Events: 1 bytes more than a sample of this type");
    bytes[3] = 1;  // padding, as some writers send it
    CHECK(decoder.decode(bytes, back));

    plab_v2_Shape shape{};
    Sample<plab_v2_Shape> shape_back;
    REQUIRE(decoder.decode(*encoder.encode(shape), shape_back));
    CHECK(std::string(shape_back->component_id).empty());
    const Bytes big_endian{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9};
    CHECK(!decoder.decode(big_endian, shape_back));
}

TEST_CASE("bytes in the other order are swapped")
{
    // A frame without bodies: six numbers of 8 bytes, two lengths of 4.
    std::vector<plab_v2_BodyState> bodies;
    Encoder encoder;
    Bytes bytes = copy_of(*encoder.encode(frame_of(bodies, 0)));
    bytes[1] = 0;
    for (auto at = bytes.begin() + 4; at < bytes.end() - 8; at += 8) std::reverse(at, at + 8);
    Decoder decoder;
    Sample<plab_v2_Frame> back;
    REQUIRE(decoder.decode(bytes, back));
    CHECK(back->step == -5);
    CHECK(back->time == 0.1);
    CHECK(back->run == 3);
}

TEST_CASE("truncated and altered bytes are refused, and leave the sample unchanged")
{
    std::vector<plab_v2_BodyState> bodies;
    Encoder encoder;
    const Bytes bytes = copy_of(*encoder.encode(frame_of(bodies, 3)));
    Decoder decoder;
    Sample<plab_v2_Frame> back;
    REQUIRE(decoder.decode(bytes, back));
    for (std::size_t n = 0; n < bytes.size(); ++n)
    {
        CAPTURE(n);
        CHECK(!decoder.decode(ByteView(bytes).first(n), back));
        CHECK(back->bodies._length == 3);
    }
    for (const int encapsulation : {2, 3, 6, 7, 9, 11, 255})
    {
        Bytes other = bytes;
        other[1] = static_cast<std::uint8_t>(encapsulation);
        CHECK(!decoder.decode(other, back));
    }
    // A length that is larger than everything that follows.
    Bytes huge = bytes;
    std::fill_n(huge.begin() + 4 + 48, 4, std::uint8_t{0xff});
    CHECK(decoder.decode(huge, back).error().text() == "plab::v2::Frame: truncated, or not a sample of this type");
}

TEST_CASE("every byte of a sample with texts changed: an error, or a sample that can be written")
{
    plab_v2_NamedText value{};
    char name[] = "velocity", text[] = "1 2 3", verb[] = "set";
    value.name = name;
    value.text = text;
    plab_v2_Operation operation{};
    operation.verb = verb;
    operation.values = {1, 1, &value, false};
    plab_v2_Request request{};
    request.operations = {1, 1, &operation, false};
    Encoder encoder;
    Bytes bytes = copy_of(*encoder.encode(request));
    Decoder decoder;
    Encoder again;
    int refused = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
        for (const int change : {0x01, 0x80, 0xff})
        {
            bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ change);
            Sample<plab_v2_Request> back;
            if (decoder.decode(bytes, back))
                CHECK(again.encode(*back)->size() > 4);
            else
                ++refused;
            bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ change);
        }
    CHECK(refused > 50);
}

TEST_CASE("frames through a file")
{
    auto file = std::make_shared<Bytes>();
    std::vector<plab_v2_BodyState> bodies;
    {
        Encoder encoder;
        auto writer = McapWriter::open(std::make_unique<MemorySink>(file), {}).take();
        const auto schema = writer.add_schema(*schema_of<plab_v2_Frame>()).take();
        const auto channel = writer.add_channel(channel_of<plab_v2_Frame>(schema)).take();
        for (std::size_t n = 0; n < 10; ++n) CHECK(writer.write({channel, 0, n, n, *encoder.encode(frame_of(bodies, n))}, {}));
        CHECK(writer.close());
    }
    auto reader = open(*file);
    REQUIRE(reader);
    CHECK(reader->schema_of(reader->channels().at(1))->name == "plab::v2::Frame");
    Decoder decoder;
    Sample<plab_v2_Frame> frame;
    auto messages = reader->messages({{"plab/states"}});
    std::size_t n = 0;
    for (auto next = messages.next(); next && *next; next = messages.next(), ++n)
    {
        REQUIRE(decoder.decode((*next)->message.data, frame));
        CHECK(frame->bodies._length == n);
    }
    CHECK(n == 10);
}
