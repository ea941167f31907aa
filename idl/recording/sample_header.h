/// What a sample says of itself: of when it is, and which number it has. Everything else in it stays bytes.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "idl/recording/records.h"
#include "idl/topics.h"
#include "plab/result.h"

namespace plab::recording
{

struct SampleHeader
{
    std::uint64_t run = 0;        ///< 0: it says none
    std::optional<double> time;   ///< s, simulated
    std::int64_t step = -1;       ///< -1: it says none; of an interaction that since which it is there
    std::int64_t stamp_ns = 0;    ///< wall clock since 1970; 0: it has none
    std::uint64_t first = 0;      ///< sequence number of its first entry, where the topic has numbers
    std::uint64_t entries = 0;    ///< with numbers; 0: the topic has none
    std::string key;              ///< of its instance, where that is a text
    std::int64_t started_ns = 0;  ///< plab/server: since when the server runs
    std::string blueprint;        ///< plab/snapshots: the scene
};

/// Looks into samples of one topic. Keeps its memory.
class Peek
{
public:
    virtual ~Peek() = default;
    /// `bytes`: as they are on the wire. An error: they are no sample of this topic.
    virtual Result<SampleHeader> at(ByteView bytes) = 0;
};

/// `topic` is one of wire::topics().
std::unique_ptr<Peek> make_peek(const wire::Topic& topic);

/// The key of a sample that has nothing else, because its instance is gone; empty if it is no text.
std::string key_of_gone(ByteView bytes);

}  // namespace plab::recording
