// A recording and what pLab reads from it, for comparison with what other programs read.
//
//   recording_pair write FILE COMPRESSION   a recording of all topics with random samples; COMPRESSION: none, lz4, zstd
//   recording_pair dump FILE                all messages, one JSON object per line, in the order of their times
//
// Numbers are quoted in the dump: JSON's own lose 64-bit integers, infinities and the sign of zero.
#include <chrono>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "idl/domain.h"
#include "idl/recording/cdr.h"
#include "idl/recording/reader.h"
#include "idl/recording/topic_file.h"
#include "idl/recording/writer.h"
#include "link/discovery.h"
#include "link/json.h"
#include "random_samples.h"

using namespace plab;
using namespace plab::recording;

namespace
{

constexpr int kSamplesPerTopic = 25;

struct Described
{
    const wire::Topic* topic = nullptr;
    link::DynamicTypePtr type;
};

/// The members of each topic's type, as described by DDS: not by the IDL text that recordings hold.
Result<std::map<std::string, Described>> describe_topics()
{
    auto participant = wire::join({});
    if (!participant) return participant.errors();
    std::map<std::string, Described> out;
    for (const wire::Topic& topic : wire::topics())
    {
        const wire::Entity made(dds_create_topic(participant->get(), topic.type, topic.name, nullptr, nullptr));
        dds_typeinfo_t* info = nullptr;
        if (const auto code = dds_get_typeinfo(made.get(), &info); code < 0) return wire::failed(topic.name, code);
        auto type = link::describe_type(participant->get(), info);
        dds_free_typeinfo(info);
        if (!type) return type.errors();
        out[topic.name] = {&topic, type.take()};
    }
    return out;
}

Result<void> write(const std::string& path, const std::string& compression)
{
    auto topics = describe_topics();
    if (!topics) return topics.errors();
    WriterOptions options;
    options.compression = compression_of(compression == "none" ? "" : compression).value_or(Compression::None);
    auto writer = McapWriter::create(path, options, Overwrite::Yes);
    if (!writer) return writer.errors();
    if (auto done = writer->add_metadata({"plab", {{"format", "2"}, {"server", "pair"}}}); !done) return done;

    std::mt19937_64 random(1);
    Clock::time_point now{};
    for (const auto& [name, described] : *topics)
    {
        auto schema = schema_of(*described.topic);
        if (!schema) return schema.errors();
        auto id = writer->add_schema(schema.take());
        if (!id) return id.errors();
        auto channel = writer->add_channel(channel_of(*described.topic, *id));
        if (!channel) return channel.errors();
        for (std::uint64_t i = 0; i < kSamplesPerTopic; ++i)
        {
            const Bytes bytes = test::random_sample(*described.type, random);
            if (!writer->write({*channel, 0, i * 1'000'000, 1'700'000'000'000'000'000 + i, bytes}, now))
                return reason("the writer drops messages");
            now += std::chrono::milliseconds(3);
        }
    }
    return writer->close();
}

/// pLab's own C structs hold the same: conversion to a sample and back gives the same bytes.
Result<void> check_round_trip(const wire::Topic& topic, ByteView bytes)
{
    std::vector<std::uint64_t> memory((topic.type->m_size + 7) / 8, 0);
    Decoder decoder;
    Encoder encoder;
    auto done = decoder.decode(bytes, memory.data(), *topic.type);
    if (done)
    {
        const auto again = encoder.encode(memory.data(), *topic.type);
        if (!again || !std::equal(again->begin(), again->end(), bytes.begin(), bytes.end()))
            done = reason(std::string(topic.name) + ": other bytes");
    }
    dds_sample_free(memory.data(), topic.type, DDS_FREE_CONTENTS);
    return done;
}

Result<void> dump(const std::string& path)
{
    auto topics = describe_topics();
    if (!topics) return topics.errors();
    auto reader = McapReader::open(path);
    if (!reader) return reader.errors();
    Cursor messages = reader->messages();
    for (auto next = messages.next();; next = messages.next())
    {
        if (!next) return next.errors();
        if (!*next) return {};
        const auto& [channel, message] = **next;
        const Described& described = topics->at(channel->topic);
        if (auto same = check_round_trip(*described.topic, message.data); !same) return same;
        auto value = link::json_of(*described.type, std::as_bytes(message.data), link::Numbers::Quoted);
        if (!value) return value.errors();
        const link::Json line{{"topic", channel->topic},
                              {"schema", reader->schema_of(*channel)->name},
                              {"log_time", std::to_string(message.log_time)},
                              {"publish_time", std::to_string(message.publish_time)},
                              {"sequence", message.sequence},
                              {"value", value.take()}};
        std::puts(link::line_of(line).c_str());
    }
}

}  // namespace

int main(int count, char** arguments)
{
    const std::string verb = count > 1 ? arguments[1] : "";
    const Result<void> done = verb == "write" && count == 4  ? write(arguments[2], arguments[3])
                              : verb == "dump" && count == 3 ? dump(arguments[2])
                                                             : reason("usage: recording_pair write FILE COMPRESSION | dump FILE");
    if (!done) std::fprintf(stderr, "recording_pair: %s\n", done.error().text().c_str());
    return done ? 0 : 1;
}
