#include "record/topic_writer.h"

#include <algorithm>
#include <cstring>

namespace plab::record
{
namespace
{

constexpr double kFullFrameEvery = 1;  ///< s, simulated

}  // namespace

TopicWriter::TopicWriter(wire::Identity identity, std::vector<std::string> topics, bool moved_only)
    : identity_(std::move(identity)), topics_(std::move(topics))
{
    if (moved_only) moved_.emplace(kFullFrameEvery);
}

bool TopicWriter::has(const char* topic) const
{
    const auto is = [&](const wire::Topic& t) { return std::strcmp(topic, t.name) == 0; };
    if (topics_.empty()) return !is(wire::topic_of<plab_v2_Image>()) && !is(wire::topic_of<plab_v2_ContactForces>());
    return std::find(topics_.begin(), topics_.end(), topic) != topics_.end();
}

template <class T>
void TopicWriter::write(const T& sample, const Stamp& stamp)
{
    const wire::Topic& topic = wire::topic_of<T>();
    if (!has(topic.name)) return;
    if (const auto bytes = encoder_.encode(sample))
        file_->write(topic, *bytes, stamp);
    else
        file_->refuse(bytes.error());
}

void TopicWriter::put(recording::TopicFile& file, Entry& entry, const Stamp& stamp)
{
    file_ = &file;
    struct Visitor
    {
        TopicWriter* self;
        Entry* entry;
        const Stamp* stamp;
        void operator()(const std::unique_ptr<wire::Frame>& frame) const { self->put_body(*frame, *stamp); }
        void operator()(const wire::Collisions& b) const { self->write(self->collisions_.of(b), *stamp); }
        void operator()(const wire::Events& b) const { self->write(self->events_.of(b), *stamp); }
        void operator()(const wire::Metrics& m) const { self->write(self->metrics_.of(m), *stamp); }
        void operator()(const wire::Image& i) const { self->write(self->image_.of(i), *stamp); }
        void operator()(const wire::Journal& j) const { self->write(self->journal_.of(j), *stamp); }
        void operator()(const wire::Hashes& h) const { self->write(self->hashes_.of(h), *stamp); }
        void operator()(const wire::Snapshot& s) const { self->write(self->snapshot_.of(s), *stamp); }
        void operator()(const wire::ContactForces& c) const { self->write(self->contacts_.of(c), *stamp); }
        void operator()(const publish::CatalogueChange& c) const { self->put_body(c, *stamp, entry->run); }
        void operator()(wire::Server& s) const
        {
            wire::sign(s, self->identity_);
            self->write(self->server_.of(s), *stamp);
        }
    };
    std::visit(Visitor{this, &entry, &stamp}, entry.body);
}

void TopicWriter::put_body(const wire::Frame& frame, const Stamp& stamp) { write(frame_.of(moved_ ? moved_->thin(frame) : frame), stamp); }

template <class T, class Value>
void TopicWriter::put_entries(wire::SampleView<T>& sample, const std::vector<Value>& entries, const Stamp& stamp)
{
    std::set<std::string>& known = known_[wire::topic_of<T>().name];
    for (const Value& entry : entries)
    {
        known.insert(entry.component_id);
        write(sample.of(entry), stamp);
    }
}

void TopicWriter::put_body(const publish::CatalogueChange& change, const Stamp& stamp, std::uint64_t run)
{
    put_gone(change, stamp, run);
    plab_v2_Scene scene = scene_.of(change.scene);
    scene.server_name = wire::text(identity_.name);
    write(scene, stamp);
    put_entries(object_, change.objects, stamp);
    put_entries(shape_, change.shapes, stamp);
    put_entries(interaction_, change.interactions, stamp);
    for (const wire::Type& type : change.types) write(type_.of(type), stamp);
}

void TopicWriter::put_gone(const publish::CatalogueChange& change, const Stamp& stamp, std::uint64_t run)
{
    for (auto& [topic, keys] : known_)
    {
        if (change.everything)
        {
            if (!keys.empty()) say_gone(topic, "", stamp, run);
            keys.clear();
        }
        for (const std::string& id : change.gone)
            if (keys.erase(id) > 0) say_gone(topic, id, stamp, run);
    }
}

void TopicWriter::say_gone(const std::string& topic, const std::string& key, const Stamp& stamp, std::uint64_t run)
{
    write(plab_v2_Gone{run, wire::text(topic), wire::text(key)}, stamp);
}

}  // namespace plab::record
