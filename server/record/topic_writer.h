/// Writes records into the file: as samples of the wire, encoded as the bus would send them.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "idl/recording/cdr.h"
#include "idl/recording/timeline.h"
#include "idl/recording/topic_file.h"
#include "record/entry.h"
#include "record/moved.h"
#include "wire/samples.h"

namespace plab::record
{

using recording::Stamp;

class TopicWriter
{
public:
    TopicWriter(wire::Identity identity, std::vector<std::string> topics, bool moved_only);

    /// Whether the file is to have this topic.
    bool has(const char* topic) const;
    void put(recording::TopicFile& file, Entry& entry, const Stamp& stamp);

private:
    void put_body(const publish::Frame& frame, const Stamp& stamp);
    void put_body(const publish::CatalogueChange& change, const Stamp& stamp, std::uint64_t run);
    template <class T>
    void write(const T& sample, const Stamp& stamp);

    template <class T, class Sample, class Item, class Key>
    void put_entries(Sample& sample, const std::vector<Item>& entries, Key key, const Stamp& stamp);
    void put_gone(const publish::CatalogueChange& change, const Stamp& stamp, std::uint64_t run);
    void say_gone(const std::string& topic, const std::string& key, const Stamp& stamp, std::uint64_t run);

    recording::TopicFile* file_ = nullptr;  ///< during put()
    wire::Identity identity_;
    std::vector<std::string> topics_;  ///< none: all but images
    recording::Encoder encoder_;
    std::map<std::string, std::set<std::string>> known_;  ///< catalogue: keys by topic
    std::optional<MovedFilter> moved_;

    wire::ServerSample server_;
    wire::SceneSample scene_;
    wire::ObjectSample object_;
    wire::ShapeSample shape_;
    wire::InteractionSample interaction_;
    wire::TypeSample type_;
    wire::FrameSample frame_;
    wire::CollisionsSample collisions_;
    wire::EventsSample events_;
    wire::MetricsSample metrics_;
    wire::ImageSample image_;
    wire::JournalSample journal_;
    wire::HashesSample hashes_;
    wire::SnapshotSample snapshot_;
};

}  // namespace plab::record
