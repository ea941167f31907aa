#include "link/catalogue.h"

#include <algorithm>

#include "idl/samples.h"

namespace plab::link
{
namespace
{

using Clock = std::chrono::steady_clock;

// The bus gives no count of types: they arrive in one burst, and are considered complete when no more have arrived for this
// long.
constexpr Seconds kQuiet(0.05);
// Metrics are optional: a server may have none to send, as in a playback. One that has them answers a new reader soon, but no sooner than
// 50 ms after its last sample, and later if it is busy.
constexpr Seconds kPatience(1);
constexpr Seconds kSlice(0.05);

template <class T>
Result<void> open_reader(const Session& session, bool wanted, wire::DataReader<T>& reader)
{
    if (!wanted) return {};
    auto made = session.reader<T>();
    if (!made) return made.errors();
    reader = made.take();
    return {};
}

/// Updates `things` with the reader's samples; true if there were any.
template <class T, class Thing>
bool take_into(wire::DataReader<T>& reader, std::map<std::string, Thing>& things, char* T::*key)
{
    if (!reader.entity().valid()) return false;
    const dds_return_t taken = reader.take(
        [&](const T& sample, const dds_sample_info_t& info)
        {
            if (info.instance_state != DDS_IST_ALIVE)
                things.erase(sample.*key);
            else if (info.valid_data)
                wire::read_sample(sample, things[sample.*key]);
        });
    return taken > 0;
}

std::string count_text(const char* what, std::size_t got, std::size_t wanted)
{
    return std::to_string(got) + " of " + std::to_string(wanted) + " " + what;
}

}  // namespace

Result<Catalogue> Catalogue::open(const Session& session, Parts parts)
{
    Catalogue c;
    c.session_ = &session;
    c.parts_ = parts | Part::Server | Part::Scene;
    for (const auto& opened :
         {open_reader(session, true, c.server_), open_reader(session, true, c.scene_),
          open_reader(session, has(parts, Part::Objects), c.objects_), open_reader(session, has(parts, Part::Shapes), c.shapes_),
          open_reader(session, has(parts, Part::Interactions), c.interactions_), open_reader(session, has(parts, Part::Types), c.types_),
          open_reader(session, has(parts, Part::Metrics), c.metrics_)})
        if (!opened) return opened.errors();
    c.waitset_ = wire::Entity(dds_create_waitset(session.participant().get()));
    if (!c.waitset_.valid()) return reason("cannot wait for the catalogue");
    for (const wire::Entity* reader : {&c.server_.entity(), &c.scene_.entity(), &c.objects_.entity(), &c.shapes_.entity(),
                                       &c.interactions_.entity(), &c.types_.entity(), &c.metrics_.entity()})
    {
        if (!reader->valid()) continue;
        (void)dds_set_status_mask(reader->get(), DDS_DATA_AVAILABLE_STATUS);
        if (const auto code = dds_waitset_attach(c.waitset_.get(), reader->get(), 0); code < 0)
            return wire::failed("cannot wait for the catalogue", code);
    }
    return c;
}

std::string Catalogue::missing() const
{
    if (!now_.server) return "the server's state";
    if (!now_.scene) return "the scene";
    if (has(parts_, Part::Objects) && now_.objects.size() < now_.scene->objects)
        return count_text("objects", now_.objects.size(), now_.scene->objects);
    if (has(parts_, Part::Interactions) && now_.interactions.size() < now_.scene->interactions)
        return count_text("interactions", now_.interactions.size(), now_.scene->interactions);
    if (has(parts_, Part::Types) && now_.types.empty()) return "types";
    if (!has(parts_, Part::Shapes) || !has(parts_, Part::Objects)) return {};
    for (const auto& [id, object] : now_.objects)
        for (const std::string& shape : object.shapes)
            if (now_.shapes.count(shape) == 0) return "shape '" + shape + "'";
    return {};
}

Result<void> Catalogue::fetch(Seconds timeout, const Stop& stop)
{
    const auto end = moment_after(timeout);
    auto last = Clock::now();
    while (true)
    {
        // The server's state and metrics change continuously: they do not count as a part of the burst.
        const std::uint64_t before = version_;
        (void)update();
        if (version_ != before) last = Clock::now();
        const std::string gap = missing();
        const bool lacks_metrics = has(parts_, Part::Metrics) && !now_.metrics;
        const Seconds quiet = lacks_metrics ? kPatience : has(parts_, Part::Types) ? kQuiet : Seconds(0);
        if (gap.empty() && (Clock::now() - last >= quiet || Clock::now() >= end)) return {};
        if (Clock::now() >= end) return reason("server '" + session_->server() + "' did not send its complete catalogue; missing: " + gap);
        if (stop && stop()) return reason("interrupted");
        const Seconds left = std::min(kSlice, Seconds(end - Clock::now()));
        (void)dds_waitset_wait(waitset_.get(), nullptr, 0, duration_of(left));
    }
}

bool Catalogue::update()
{
    const std::uint64_t before = version_;
    bool changed = take_state();
    if (take_things()) ++version_, rebuild_handles();
    return changed || version_ != before;
}

bool Catalogue::wait(Seconds timeout)
{
    const auto end = moment_after(timeout);
    do {
        const Seconds left = std::max(Seconds(0), Seconds(end - Clock::now()));
        (void)dds_waitset_wait(waitset_.get(), nullptr, 0, duration_of(left));
        if (update()) return true;
    } while (Clock::now() < end);
    return false;
}

bool Catalogue::take_state()
{
    bool changed = server_.take(
                       [&](const plab_v2_Server& sample, const dds_sample_info_t& info)
                       {
                           if (info.instance_state != DDS_IST_ALIVE)
                               now_.server.reset();
                           else if (info.valid_data)
                               now_.server = wire::value_of<ServerInfo>(sample), was_there_ = true;
                       }) > 0;
    if (!metrics_.entity().valid()) return changed;
    changed |= metrics_.take(
                   [&](const plab_v2_Metrics& sample, const dds_sample_info_t& info)
                   {
                       if (info.valid_data) now_.metrics = wire::value_of<Metrics>(sample);
                   }) > 0;
    return changed;
}

bool Catalogue::take_things()
{
    bool changed = scene_.take(
                       [&](const plab_v2_Scene& sample, const dds_sample_info_t& info)
                       {
                           if (info.valid_data && info.instance_state == DDS_IST_ALIVE) now_.scene = wire::value_of<Scene>(sample);
                       }) > 0;
    changed |= take_into(objects_, now_.objects, &plab_v2_SceneObject::component_id);
    changed |= take_into(shapes_, now_.shapes, &plab_v2_Shape::component_id);
    changed |= take_into(interactions_, now_.interactions, &plab_v2_Interaction::component_id);
    changed |= take_into(types_, now_.types, &plab_v2_Type::type_name);
    return changed;
}

void Catalogue::rebuild_handles()
{
    handles_.clear();
    for (const auto& [id, object] : now_.objects) handles_[object.handle] = id;
}

const Object* Catalogue::find_object(std::uint32_t handle) const
{
    const auto at = handles_.find(handle);
    if (at == handles_.end()) return nullptr;
    const auto object = now_.objects.find(at->second);
    return object == now_.objects.end() ? nullptr : &object->second;
}

}  // namespace plab::link
