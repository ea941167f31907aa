/// Writes records into the file: as samples of the wire, encoded as the bus would send them.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "idl/identity.h"
#include "idl/recording/cdr.h"
#include "idl/recording/timeline.h"
#include "idl/recording/topic_file.h"
#include "idl/samples.h"
#include "record/entry.h"
#include "record/moved.h"

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
    void put_body(const wire::Frame& frame, const Stamp& stamp);
    void put_body(const publish::CatalogueChange& change, const Stamp& stamp, std::uint64_t run);
    template <class T>
    void write(const T& sample, const Stamp& stamp);

    template <class T, class Value>
    void put_entries(wire::SampleView<T>& sample, const std::vector<Value>& entries, const Stamp& stamp);
    void put_gone(const publish::CatalogueChange& change, const Stamp& stamp, std::uint64_t run);
    void say_gone(const std::string& topic, const std::string& key, const Stamp& stamp, std::uint64_t run);

    recording::TopicFile* file_ = nullptr;  ///< during put()
    wire::Identity identity_;
    std::vector<std::string> topics_;  ///< none: all but images and contacts
    recording::Encoder encoder_;
    std::map<std::string, std::set<std::string>> known_;  ///< catalogue: keys by topic
    std::optional<MovedFilter> moved_;

    wire::SampleView<plab_v2_Server> server_;
    wire::SampleView<plab_v2_Scene> scene_;
    wire::SampleView<plab_v2_SceneObject> object_;
    wire::SampleView<plab_v2_Shape> shape_;
    wire::SampleView<plab_v2_Interaction> interaction_;
    wire::SampleView<plab_v2_Type> type_;
    wire::SampleView<plab_v2_Frame> frame_;
    wire::SampleView<plab_v2_Collisions> collisions_;
    wire::SampleView<plab_v2_Events> events_;
    wire::SampleView<plab_v2_Metrics> metrics_;
    wire::SampleView<plab_v2_Image> image_;
    wire::SampleView<plab_v2_Journal> journal_;
    wire::SampleView<plab_v2_Hashes> hashes_;
    wire::SampleView<plab_v2_Snapshot> snapshot_;
    wire::SampleView<plab_v2_ContactForces> contacts_;
};

}  // namespace plab::record
