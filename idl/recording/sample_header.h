/// The time and number that a sample contains. The rest of its payload is not decoded.
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
    std::uint64_t run = 0;        ///< 0: it contains none
    std::optional<double> time;   ///< s, simulated
    std::int64_t step = -1;       ///< -1: it contains none; of an interaction, the step at which its algorithm became active
    std::int64_t stamp_ns = 0;    ///< wall clock since 1970; 0: it has none
    std::uint64_t first = 0;      ///< sequence number of its first entry, if the topic is numbered
    std::uint64_t entries = 0;    ///< number of numbered entries; 0: the topic is not numbered
    std::string key;              ///< key of its instance, if that is a text
    std::int64_t started_ns = 0;  ///< plab/server: start time of the server
    std::string blueprint;        ///< plab/snapshots: the scene
};

/// Extracts headers from samples of one topic. Reuses its memory.
class Peek
{
public:
    virtual ~Peek() = default;
    /// `bytes`: in wire format. An error: they are not a sample of this topic.
    virtual Result<SampleHeader> at(ByteView bytes) = 0;
};

/// `topic` is one of wire::topics().
std::unique_ptr<Peek> make_peek(const wire::Topic& topic);

/// The key of a sample that contains only the key because its instance is gone; empty if it is not a text.
std::string key_of_gone(ByteView bytes);

}  // namespace plab::recording
