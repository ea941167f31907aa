/// The catalogue of a recording: what its topics for late joiners hold at a time.
#pragma once

#include <map>
#include <set>
#include <string>

#include "idl/recording/glance.h"
#include "idl/recording/reader.h"

namespace plab::playback
{

/// Topic and key.
using Place = std::pair<std::string, std::string>;

/// Whether a topic has instances that come, stay and go: objects, shapes, interactions, types, the scene.
bool is_catalogue(const std::string& topic);

class Shelf
{
public:
    Shelf();

    /// A sample of a catalogue topic.
    Result<Place> put(const std::string& topic, recording::ByteView bytes);
    /// Takes what a sample of plab/gone names off the shelf. An error: it is no such sample.
    Result<std::set<Place>> remove(recording::ByteView gone);

    const std::map<Place, recording::Bytes>& entries() const { return entries_; }
    bool has(const Place& place) const { return entries_.contains(place); }

private:
    std::map<std::string, std::unique_ptr<recording::Peek>> peeks_;
    std::map<Place, recording::Bytes> entries_;
};

/// What stands there after all that has come until `time`, and at it. What is damaged is left out.
Shelf shelf_at(const recording::Reader& reader, std::uint64_t time);

}  // namespace plab::playback
