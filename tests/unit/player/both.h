/// A player and its readers, in one process and on one thread: while a reader waits, the player continues.
#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <map>

#include "analysis/made_recording.h"
#include "control/recording/player/player.h"
#include "control/recording/recorder/recorder.h"
#include "idl/recording/reader.h"

namespace plab::test
{

using Clock = std::chrono::steady_clock;
using link::Seconds;

/// Tests may run side by side, in several checkouts.
inline wire::DomainOptions test_domain() { return {60 + static_cast<std::uint32_t>(getpid()) % 150, {}}; }

inline player::PlaybackOptions play_options(const std::string& file, const std::string& name)
{
    player::PlaybackOptions options;
    options.file = file, options.name = name, options.version = "test", options.domain = test_domain();
    return options;
}

inline std::unique_ptr<player::Player> open_player(const player::PlaybackOptions& options)
{
    auto player = player::Player::open(options);
    REQUIRE_MESSAGE(player.ok(), player.error().text());
    return player.take();
}

/// Runs the player until `is_enough`, for 10 s at the most; returns whether it was.
template <class Condition>
bool play_until(player::Player& player, Condition is_enough)
{
    const auto end = Clock::now() + std::chrono::seconds(10);
    bool is_there = is_enough();
    for (; !is_there && Clock::now() < end; is_there = is_enough())
    {
        const auto now = Clock::now();
        REQUIRE(player.step(now).ok());
        if (!player.is_over()) player.wait(now + std::chrono::milliseconds(5));
    }
    return is_there;
}

inline link::Session watch(const std::string& name)
{
    link::SessionOptions options;
    options.server = name, options.domain = test_domain();
    auto session = link::Session::join(options);
    REQUIRE_MESSAGE(session.ok(), session.error().text());
    return session.take();
}

/// Everything that a reader of T has received so far, as text by `note`.
template <class T, class Note>
void take_all(wire::DataReader<T>& reader, Note note)
{
    (void)reader.take(
        [&](const T& sample, const dds_sample_info_t& info)
        {
            if (info.valid_data) note(sample);
        });
}

inline recording::McapReader open_file(const std::string& file)
{
    auto reader = recording::McapReader::open(file);
    REQUIRE_MESSAGE(reader.ok(), reader.error().text());
    return reader.take();
}

/// The bytes of all messages of a topic, in their order.
inline std::vector<recording::Bytes> messages_of(const recording::McapReader& reader, const std::string& topic)
{
    std::vector<recording::Bytes> out;
    recording::Cursor cursor = reader.messages({{topic}});
    for (auto next = cursor.next(); next && *next; next = cursor.next())
        out.emplace_back((*next)->message.data.begin(), (*next)->message.data.end());
    return out;
}

}  // namespace plab::test
