#include "publish/catalogue_tracker.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "publish/entries.h"

namespace plab::publish
{
namespace
{

/// The components that have a name for people, or that another component asked for, by id.
using Named = std::unordered_map<std::string_view, const model::ComponentSpec*>;

Named named_in(const model::SceneSpec& scene)
{
    Named out;
    for (const model::ComponentSpec& spec : scene.components)
        if (!spec.name.empty() || !spec.made_by.empty()) out.emplace(spec.id, &spec);
    return out;
}

/// Which component asked for it, as a parameter of the kind "made".
void add_maker(const model::ComponentSpec* spec, std::vector<wire::Parameter>& out)
{
    if (spec && !spec->made_by.empty()) out.push_back({"made_by", spec->made_by, "", "made"});
}

void add_entry(const simulation::Simulation& s, const Roster::Member& member, const std::string& id, const Named& named,
               CatalogueChange& out)
{
    const auto found = named.find(id);
    const model::ComponentSpec* spec = found == named.end() ? nullptr : found->second;
    const std::string name = spec ? spec->name : std::string();
    switch (member.kind)
    {
        case Roster::Kind::Object:
            out.objects.push_back(object_entry(s, member, name));
            add_maker(spec, out.objects.back().parameters);
            break;
        case Roster::Kind::Shape:
            out.shapes.push_back(shape_entry(s, member));
            break;
        case Roster::Kind::Interaction:
            out.interactions.push_back(interaction_entry(s, member, name));
            add_maker(spec, out.interactions.back().parameters);
            break;
    }
}

}  // namespace

CatalogueTracker::CatalogueTracker(const std::vector<model::TypeSummary>& types)
{
    for (const model::TypeSummary& type : types) types_.push_back(type_entry(type));
}

void CatalogueTracker::follow(const simulation::Simulation& s, const simulation::Changes& changes, Tick boundary)
{
    const bool anew = changes.everything || run_ != s.run();
    if (anew)
    {
        clear();
        roster_.restart();
        scripted_.clear();
        everything_ = true, tables_ = 0;
    }
    if (anew || revision_ != s.revision()) compare(s, boundary);
    run_ = s.run(), revision_ = s.revision();
    scene_changed_ = scene_changed_ || dt_ != s.dt();
    dt_ = s.dt();
    scripted_.insert(changes.by_scripts.begin(), changes.by_scripts.end());
    if (changes.touched.empty() && !came_or_went_) return;
    touched_.insert(changes.touched.begin(), changes.touched.end());
    spread(s);
    came_or_went_ = false;
}

void CatalogueTracker::compare(const simulation::Simulation& s, Tick boundary)
{
    Roster::Differences d = roster_.update(s.world(), boundary);
    mark_loaded_types(s.world());
    everything_ = everything_ || d.other_kind;
    came_or_went_ = !d.came.empty() || !d.gone.empty();
    scene_changed_ = scene_changed_ || came_or_went_;
    for (std::string& id : d.came) gone_.erase(id), touched_.insert(std::move(id));
    for (std::string& id : d.retyped) touched_.insert(std::move(id));
    for (std::string& id : d.gone) touched_.erase(id), gone_.insert(std::move(id));
}

/// Whether `spec` changes along with the components that are already known to change.
bool CatalogueTracker::mark_dependent(const world::World& world, const model::ComponentSpec& spec)
{
    if (touched_.contains(spec.id)) return false;
    const auto is_touched_shape = [&](const std::string& id)
    {
        const Roster::Member* member = touched_.contains(id) ? roster_.find(id) : nullptr;
        return member && member->kind == Roster::Kind::Shape;
    };
    bool follows = !spec.parent.empty() && touched_.contains(spec.parent);
    for (const model::RoleSpec& role : spec.roles)
    {
        // "*" refers to other components now; a body's mass comes from its shape.
        follows = follows || (role.everyone && came_or_went_);
        follows = follows || std::any_of(role.members.begin(), role.members.end(), is_touched_shape);
    }
    if (follows && world.find(spec.id) != kNoIndex) touched_.insert(spec.id);
    return follows;
}

void CatalogueTracker::spread(const simulation::Simulation& s)
{
    // The whole catalogue is sent anyway.
    if (everything_) return;
    for (bool grown = true; grown;)
    {
        grown = false;
        for (const model::ComponentSpec& spec : s.world().scene().components) grown = mark_dependent(s.world(), spec) || grown;
    }
}

void CatalogueTracker::mark_loaded_types(const world::World& world)
{
    // A type with a table came from a plugin, which was loaded with all of its types.
    if (tables_ == world.tables().size()) return;
    tables_ = world.tables().size();
    std::set<std::string_view> plugins;
    for (const auto& table : world.tables()) plugins.insert(table->type().plugin);
    for (wire::Type& type : types_)
        if (!type.is_loaded && plugins.contains(type.plugin)) type.is_loaded = types_changed_ = true;
}

void CatalogueTracker::release_scripted(const simulation::Simulation& s)
{
    if (scripted_.empty()) return;
    for (const std::uint32_t i : scripted_)
        if (i < s.world().components().size() && s.world().component(i).alive) touched_.insert(s.world().id_of(i));
    scripted_.clear();
    spread(s);
}

CatalogueChange CatalogueTracker::everything(const simulation::Simulation& s) const
{
    CatalogueChange out;
    out.everything = true, out.scene = scene_entry(s, roster_), out.types = types_;
    const Named named = named_in(s.world().scene());
    for (const auto& [id, member] : roster_.members()) add_entry(s, member, id, named, out);
    return out;
}

CatalogueChange CatalogueTracker::changes(const simulation::Simulation& s) const
{
    CatalogueChange out;
    out.scene = scene_entry(s, roster_);
    if (types_changed_) out.types = types_;
    out.gone.assign(gone_.begin(), gone_.end());
    const Named named = named_in(s.world().scene());
    for (const std::string& id : touched_)
        if (const Roster::Member* member = roster_.find(id)) add_entry(s, *member, id, named, out);
    return out;
}

void CatalogueTracker::clear()
{
    everything_ = scene_changed_ = types_changed_ = came_or_went_ = false;
    touched_.clear(), gone_.clear();
}

}  // namespace plab::publish
