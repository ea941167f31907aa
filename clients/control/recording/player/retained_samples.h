/// The catalogue of a recording: the samples that its topics for late joiners retain at a given time.
#pragma once

#include <map>
#include <set>
#include <string>

#include "idl/recording/reader.h"
#include "idl/recording/sample_header.h"

namespace plab::player
{

/// Topic and key.
using InstanceKey = std::pair<std::string, std::string>;

/// Whether the instances of a topic come and go: objects, shapes, interactions, types, the scene.
bool is_catalogue(const std::string& topic);

class RetainedSamples
{
public:
    RetainedSamples();

    /// A sample of a catalogue topic.
    Result<InstanceKey> put(const std::string& topic, recording::ByteView bytes);
    /// Removes what a sample of plab/gone names. An error: it is not such a sample.
    Result<std::set<InstanceKey>> remove(recording::ByteView gone);

    const std::map<InstanceKey, recording::Bytes>& entries() const { return entries_; }
    bool has(const InstanceKey& place) const { return entries_.contains(place); }

private:
    std::map<std::string, std::unique_ptr<recording::Peek>> peeks_;
    std::map<InstanceKey, recording::Bytes> entries_;
};

/// The samples retained after everything up to and including `time`. Damaged ones are skipped.
RetainedSamples retained_at(const recording::McapReader& reader, std::uint64_t time);

}  // namespace plab::player
