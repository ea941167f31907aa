// Services that add and remove entities, and load another world.
#include <cmath>

#include "idl/values/ros_names.h"
#include "ros/service_desk.h"

namespace plab::ros
{
namespace
{

std::string joined(const Errors& errors)
{
    std::string out;
    for (const Error& error : errors) out += (out.empty() ? "" : "\n") + error.text();
    return out;
}

}  // namespace

Outcome ServiceDesk::place_of(const msg::Spawn& spawn, Pose& out) const
{
    constexpr double kTolerance = 1e-3;
    out = pose_from(spawn.initial_pose.pose);
    if (!is_finite(out.p) || !is_finite(out.q) || std::abs(norm(out.q) - 1) > kTolerance)
        return {Code::SpawnInvalidPose, "the pose must be finite, and its quaternion of unit length"};
    out.q = normalized(out.q);
    const std::string in = text_of(spawn.initial_pose.header.frame_id);
    if (in.empty() || in == kWorldFrame) return {};
    const SceneFrame* const frame = find_entity(in);
    if (frame == nullptr) return {Code::SpawnInvalidPose, "there is no frame '" + in + "'"};
    if (view_.newest_frame() == nullptr && !frame->is_static) return {Code::SpawnInvalidPose, "where '" + in + "' is now is not known"};
    out = Motions(view_.newest_frame()).of(*frame).pose * out;
    return {};
}

Outcome ServiceDesk::name_of(const msg::Spawn& spawn, const ReadResource& resource, std::string& out) const
{
    constexpr std::size_t kLongest = 120;
    const std::string space = text_of(spawn.entity_namespace);
    if (!wire::ros::is_namespace(space)) return {Code::NamespaceInvalid, "'" + space + "' is no namespace of ROS"};
    std::string name = text_of(spawn.name);
    if (name.empty())
        name = first_attribute(resource.text, resource.format == "plab" ? "id" : resource.format == "urdf" ? "name" : "model");
    if (name.empty() && spawn.allow_renaming) name = "entity";
    if (!space.empty()) name = wire::ros::normal_namespace(space).substr(1) + "/" + name;
    if (text_of(spawn.name).empty() && name.empty()) return {Code::NameInvalid, "the entity needs a name"};
    if (name.size() > kLongest || plain_name(name) != name)
        return {Code::NameInvalid, "a name has at most 120 letters, digits and _ . - /, and begins with a letter, a digit or _"};
    const auto is_taken = [&](const std::string& wanted)
    {
        const link::CatalogueContents& scene = view_.catalogue->now();
        return wanted == kWorldFrame || spawned_.contains(wanted) || scene.objects.contains(wanted) || scene.shapes.contains(wanted) ||
               scene.interactions.contains(wanted) || !view_.names->id_of(wanted).empty();
    };
    out = name;
    if (!is_taken(name)) return {};
    if (!spawn.allow_renaming) return {Code::NameNotUnique, "the name '" + name + "' is taken"};
    for (int n = 2; is_taken(out); ++n) out = name + "_" + std::to_string(n);
    return {};
}

Outcome ServiceDesk::prepare_spawn(const msg::Spawn& spawn, PreparedSpawn& out) const
{
    const auto resource = read_resource(spawn.entity_resource);
    if (!resource && resource.error().reason.empty()) return {Code::SpawnNoResource, "neither a URI nor a text is given"};
    if (!resource) return {Code::SpawnParseError, resource.error().text()};
    if (resource->format.empty() || (resource->format != "plab" && !converter_))
        return {Code::SpawnFormat, "begins with <" + first_element(resource->text) + ">, not with <component>, <robot> or <mujoco>"};
    Pose place;
    if (const Outcome placed = place_of(spawn, place); !placed.ok()) return placed;
    if (const Outcome named = name_of(spawn, *resource, out.id); !named.ok()) return named;
    if (resource->format != "plab")
    {
        auto converted = converter_({resource->text, resource->format, resource->file, out.id, place});
        if (!converted) return {Code::SpawnParseError, joined(converted.errors())};
        out.blueprint = std::move(converted->blueprint), out.body = std::move(converted->root);
        return {};
    }
    if (first_element(resource->text) == "plab")
        return {Code::SpawnFormat, "an entity is one <component>; a <plab> is a world, for load_world"};
    auto component = with_name_and_place(resource->text, out.id, place);
    if (!component) return {Code::SpawnInvalidPose, component.error().reason};
    out.blueprint = component.take();
    return {};
}

/// Finds the first body of what has come.
void ServiceDesk::note_spawned(const PreparedSpawn& prepared, const std::set<std::string>& before)
{
    view_.follow_catalogue();
    std::string& body = spawned_[prepared.id];
    for (const std::string& known : {prepared.id, prepared.body})
        if (view_.frames->find_id(known) != nullptr) body = known;
    for (const SceneFrame& frame : view_.frames->all())
        if (body.empty() && !before.contains(frame.id)) body = frame.id;
}

void ServiceDesk::spawn(const msg::Spawn& spawn, const std::function<void(const Outcome&, const std::string& name)>& then)
{
    PreparedSpawn prepared;
    if (const Outcome outcome = prepare_spawn(spawn, prepared); !outcome.ok()) return then(outcome, {});
    std::set<std::string> before;
    for (const SceneFrame& frame : view_.frames->all()) before.insert(frame.id);
    spawned_.emplace(prepared.id, "");  // the name is taken from now on
    link::Operation add;
    add.verb = "add", add.blueprint = prepared.blueprint;
    ask({add},
        [this, then, prepared, before](const Outcome& outcome, const link::Reply*)
        {
            if (outcome.ok())
            {
                note_spawned(prepared, before);
                return then(outcome, prepared.id);
            }
            spawned_.erase(prepared.id);
            then({Code::SpawnParseError, outcome.text}, {});
        });
}

void ServiceDesk::handle(const msg::SpawnEntity::Request& request, Answer<msg::SpawnEntity> answer)
{
    const msg::Spawn wanted{request.name, request.allow_renaming, request.entity_resource, request.entity_namespace, request.initial_pose};
    spawn(wanted,
          [answer](const Outcome& outcome, const std::string& name)
          {
              msg::SpawnEntity::Response response{};
              response.entity_name = wire::text(name);
              answer.give(outcome, response);
          });
}

namespace
{

/// The results of several spawns, until the last one is known.
struct SpawnResults
{
    std::vector<Outcome> outcomes;
    std::vector<std::string> names;
    std::size_t missing = 0;
};

void send(const SpawnResults& results, const Answer<msg::SpawnEntities>& answer)
{
    msg::SpawnEntities::Response response{};
    std::vector<msg::SpawnResult> items;
    Outcome all;
    for (std::size_t i = 0; i < results.outcomes.size(); ++i)
    {
        const Outcome& one = results.outcomes[i];
        if (!one.ok()) all = {Code::SomeFailed, "at least one entity was not added; see results"};
        items.push_back({{static_cast<std::uint8_t>(one.code), wire::text(one.text)}, wire::text(results.names[i])});
    }
    show(response.results, items);
    answer.give(all, response);
}

}  // namespace

void ServiceDesk::handle(const msg::SpawnEntities::Request& request, Answer<msg::SpawnEntities> answer)
{
    constexpr std::size_t kMost = 64;
    const auto wanted = wire::items(request.spawn_requests);
    if (wanted.size() > kMost) return answer(Outcome{Code::SomeFailed, "at most 64 entities can be added by one call"});
    const auto results = std::make_shared<SpawnResults>();
    results->outcomes.resize(wanted.size()), results->names.resize(wanted.size()), results->missing = wanted.size();
    if (wanted.empty()) return send(*results, answer);
    for (std::size_t i = 0; i < wanted.size(); ++i)
        spawn(wanted[i],
              [answer, results, i](const Outcome& outcome, const std::string& name)
              {
                  results->outcomes[i] = outcome, results->names[i] = name;
                  if (--results->missing == 0) send(*results, answer);
              });
}

void ServiceDesk::handle(const msg::DeleteEntity::Request& request, Answer<msg::DeleteEntity> answer)
{
    const std::string name = text_of(request.entity);
    const SceneFrame* const frame = find_entity(name);
    // What was added as a group goes as a group.
    const std::string id = spawned_.contains(name) ? name : frame != nullptr ? frame->id : "";
    if (id.empty()) return answer(Outcome{Code::NotFound, "there is no entity '" + name + "'"});
    ask({{"remove", id, {}, {}, {}}},
        [this, answer, id](const Outcome& outcome, const link::Reply*)
        {
            if (outcome.ok()) spawned_.erase(id), view_.follow_catalogue();
            answer(outcome);
        });
}

void ServiceDesk::handle(const msg::LoadWorld::Request& request, Answer<msg::LoadWorld> answer)
{
    const auto resource = read_resource(request.world_resource);
    if (!resource && resource.error().reason.empty()) return answer(Outcome{Code::WorldNoResource, "neither a URI nor a text is given"});
    if (!resource) return answer(Outcome{Code::WorldParseError, resource.error().text()});
    link::Operation load;
    load.verb = "load", load.argument = resource->file, load.blueprint = resource->text;
    if (resource->format.empty() || (resource->format != "plab" && !converter_))
        return answer(
            Outcome{Code::WorldFormat, "begins with <" + first_element(resource->text) + ">, not with <plab>, <robot> or <mujoco>"});
    if (resource->format != "plab")
    {
        auto converted = converter_({resource->text, resource->format, resource->file, {}, {}});
        if (!converted) return answer(Outcome{Code::WorldParseError, joined(converted.errors())});
        if (request.fail_on_unsupported_element && !converted->losses.empty())
            return answer(Outcome{Code::UnsupportedElements, joined(converted->losses)});
        load.blueprint = std::move(converted->blueprint);
    }
    const auto loaded = [this, answer](const Outcome& outcome, const link::Reply*)
    {
        if (!outcome.ok()) return answer(Outcome{Code::WorldParseError, outcome.text});
        spawned_.clear(), is_paused_at_start_ = false, view_.follow_catalogue();
        msg::LoadWorld::Response response{};
        wire::SequenceMemory memory;
        describe_world(response.world, memory);
        answer.give({}, response);
    };
    // A loaded world is stopped.
    ask({{"pause", {}, {}, {}, {}}},
        [this, answer, load, loaded](const Outcome& outcome, const link::Reply*)
        {
            if (!outcome.ok()) return answer(outcome);
            ask({load}, loaded);
        });
}

}  // namespace plab::ros
