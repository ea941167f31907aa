#include "world/world.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "model/alike.h"
#include "model/names.h"

namespace plab::world
{

std::uint32_t World::insert(Component component)
{
    Directory& directory = directory_.edit();
    std::uint32_t i = static_cast<std::uint32_t>(directory.components.size());
    if (directory.free.empty())
        directory.components.emplace_back();
    else
    {
        i = directory.free.back();
        directory.free.pop_back();
    }
    component.alive = true;
    directory.index_of_id.edit()[component.id] = i;
    directory.components[i] = std::move(component);
    return i;
}

void World::erase(std::uint32_t i)
{
    Directory& directory = directory_.edit();
    directory.index_of_id.edit().erase(directory.components[i].id);
    directory.components[i] = {};
    directory.free.push_back(i);
}

void World::quarantine(std::uint32_t i, bool quarantined)
{
    if (component(i).quarantined == quarantined) return;
    note(i);
    directory_.edit().components[i].quarantined = quarantined;
}

void World::describe(const model::SceneSettings& settings, const std::string& file)
{
    model::SceneSpec& scene = scene_.edit();
    scene.settings = settings, scene.file = file;
}

void World::sort_by_id()
{
    ++revisions_.order;
    in_id_order_.clear();
    rank_.assign(components().size(), kNoIndex);
    // std::map iterates in byte-wise order of ids, which is the order that every phase, hash and listing uses.
    for (const auto& [id, i] : *directory_->index_of_id)
    {
        rank_[i] = static_cast<std::uint32_t>(in_id_order_.size());
        in_id_order_.push_back(i);
    }
}

Result<std::uint32_t> World::table_for(const std::string& type_name)
{
    if (const auto found = table_of_type_.find(type_name); found != table_of_type_.end()) return found->second;
    auto type = types_->require(type_name);
    if (!type) return type.errors();
    tables_.push_back(std::make_unique<Table>(**type));
    const auto index = static_cast<std::uint32_t>(tables_.size() - 1);
    table_of_type_[type_name] = index;
    return index;
}

std::uint64_t World::enabled_commands(const model::ComponentType& type, const model::ComponentSpec& spec) const
{
    std::uint64_t mask = 0;
    for (std::size_t i = 0; i < type.info.commands.size(); ++i)
    {
        const CommandInfo& command = type.info.commands[i];
        // Linearize is a part of the force that it describes, and is used with it only.
        const bool intrinsic = command.phase == Phase::Measure || command.phase == Phase::Prepare || command.phase == Phase::Linearize;
        const bool listed = std::find(spec.commands.begin(), spec.commands.end(), command.name) != spec.commands.end();
        // Connect contributes a coupling, so it is active whenever any command of the component was selected.
        const bool connects = command.phase == Phase::Connect && !spec.commands.empty();
        if (!spec.explicit_commands || intrinsic || listed || connects) mask |= 1ull << i;
    }
    return mask;
}

void World::fill_fields(Table& table, Row row, const model::ComponentSpec& spec)
{
    for (const model::FieldSpec& given : spec.fields)
        if (const Field* field = table.schema().find_field(given.name)) field->column->set(row, given.value);
}

Result<std::uint32_t> World::create(const model::ComponentSpec& spec)
{
    Component c;
    c.id = spec.id;
    if (spec.type.empty()) return insert(std::move(c));
    auto table_index = table_for(spec.type);
    if (!table_index) return table_index.errors();
    Table& table = *tables_[*table_index];
    c.table = *table_index;
    c.facet = table.type().info.facet;
    c.commands = enabled_commands(table.type(), spec);
    const std::uint32_t i = insert(std::move(c));
    Component& placed = directory_.edit().components[i];
    placed.host_index = host_.add(placed.facet, i);
    placed.row = table.add(i, placed.host_index);
    fill_fields(table, placed.row, spec);
    return i;
}

std::vector<Ref> World::everyone_in(const Role& role, const std::vector<std::string>& patterns) const
{
    std::vector<Ref> out;
    for (const std::uint32_t i : in_id_order_)
    {
        const Component& c = directory_->components[i];
        if (c.table == kNoIndex || std::find(role.facets.begin(), role.facets.end(), c.facet) == role.facets.end()) continue;
        if (c.facet == Facet::Component && tables_[c.table]->type().info.name.rfind(role.family, 0) != 0) continue;
        if (!model::takes_part(patterns, c.id)) continue;
        out.push_back(c.ref(i));
    }
    return out;
}

void World::bind_role(const Role& role, Row row, const model::RoleSpec* spec)
{
    std::vector<Ref> refs;
    if (spec && spec->everyone)
        refs = everyone_in(role, spec->patterns);
    else if (spec)
        for (const std::string& id : spec->members)
            if (const std::uint32_t i = find(id); i != kNoIndex) refs.push_back(directory_->components[i].ref(i));
    if (role.one) (*role.one)[row] = refs.empty() ? Ref{} : refs.front();
    if (role.many) (*role.many)[row] = std::move(refs);
}

void World::bind(std::uint32_t component, const model::ComponentSpec& spec)
{
    const Table& table = table_of(component);
    for (const Role& role : table.schema().roles())
    {
        const auto given =
            std::find_if(spec.roles.begin(), spec.roles.end(), [&](const model::RoleSpec& r) { return r.name == role.name; });
        bind_role(role, directory_->components[component].row, given == spec.roles.end() ? nullptr : &*given);
    }
}

void World::initialize_motion(std::uint32_t component)
{
    const Component& c = directory_->components[component];
    if (c.host_index == kNoIndex) return;
    for (const Field& field : table_of(component).schema().fields())
        if (field.hosted) set_hosted(host_, c.facet, c.host_index, field.name, field.column->get(c.row));
    if (c.facet == Facet::Shaft)
    {
        host_.shafts.root[c.host_index] = c.host_index;
        host_.shafts.anchor[c.host_index] = host_.shafts.root_anchor[c.host_index] = host_.shafts.angle[c.host_index];
    }
}

namespace
{

/// Adds the component's name and place to errors that have none.
void add_placed(Errors& out, const Errors& errors, const model::ComponentSpec& spec)
{
    for (Error e : errors)
    {
        if (e.element.empty()) e.element = spec.id + " (" + spec.type + ")";
        if (e.where.file.empty()) e.where = spec.where;
        out.push_back(std::move(e));
    }
}

}  // namespace

/// Creates rows for the components of the scene from the `first` one on, with their values and roles; nothing is prepared yet.
std::vector<World::Created> World::create_from(std::size_t first, Errors& errors)
{
    std::vector<Created> created;
    const model::ComponentList& specs = scene_->components;
    created.reserve(specs.size() - first);
    directory_.edit().components.reserve(components().size() + specs.size() - first);
    for (std::size_t k = first; k < specs.size(); ++k)
    {
        auto made = create(specs[k]);
        if (made)
            created.push_back({*made, &specs[k]});
        else
            errors.insert(errors.end(), made.errors().begin(), made.errors().end());
    }
    sort_by_id();
    for (const Created& c : created)
        if (component(c.component).table != kNoIndex) bind(c.component, *c.spec);
    return created;
}

std::vector<World::Created> World::in_order_of_preparation(const std::vector<Created>& created) const
{
    struct PreparationRank
    {
        int order;
        std::uint32_t rank, index;
    };
    std::vector<PreparationRank> places;
    places.reserve(created.size());
    for (std::uint32_t k = 0; k < created.size(); ++k)
        places.push_back({prepare_order(created[k].component), rank_[created[k].component], k});
    std::sort(places.begin(), places.end(),
              [](const PreparationRank& a, const PreparationRank& b) { return std::pair(a.order, a.rank) < std::pair(b.order, b.rank); });
    std::vector<Created> out;
    out.reserve(created.size());
    for (const PreparationRank& place : places) out.push_back(created[place.index]);
    return out;
}

Result<void> World::add(const model::SceneSpec& fragment)
{
    const std::size_t first = scene_->components.size();
    scene_.edit().components.append(fragment.components);
    return add_from(first);
}

Result<void> World::add(const Shared<model::SceneSpec>& whole)
{
    const std::size_t first = scene_->components.size();
    assert(whole->components.size() >= first);
    scene_ = whole;
    return add_from(first);
}

Result<void> World::add_from(std::size_t first)
{
    Errors errors;
    const std::vector<Created> created = create_from(first, errors);
    if (!errors.empty()) return model::first_of_alike(std::move(errors));
    for (const Created& c : in_order_of_preparation(created))
    {
        // prepare() searches all components for the place of an error, so after a first error the cost would be quadratic in their
        // number. Its other results are not needed then, except for shapes, by which bodies are measured.
        const bool in_full = errors.empty() || component(c.component).facet == Facet::Shape;
        auto done = in_full || component(c.component).table == kNoIndex ? prepare(c.component) : run(c.component, Phase::Prepare);
        if (!done) add_placed(errors, done.errors(), *c.spec);
        initialize_motion(c.component);
    }
    if (!errors.empty()) return model::first_of_alike(std::move(errors));
    refresh_open_roles();
    return {};
}

void World::refresh_open_roles()
{
    for (const model::ComponentSpec& spec : scene_->components)
        for (const model::RoleSpec& role : spec.roles)
            if (role.everyone)
            {
                const std::uint32_t i = find(spec.id);
                bind_role(*table_of(i).schema().find_role(role.name), directory_->components[i].row, &role);
            }
}

void World::remove(std::uint32_t component)
{
    const Component c = directory_->components[component];
    scene_.edit().components.remove_if([&](const model::ComponentSpec& s) { return s.id == c.id; });
    if (c.table != kNoIndex)
    {
        parked_.push_back({c.table, c.row, c.host_index, c.facet});
        tables_[c.table]->assign(c.row, kNoIndex, kNoIndex);
        host_.disown(c.facet, c.host_index);
        if (c.facet == Facet::Body) host_.bodies.motion[c.host_index] = Motion::Static;
        if (c.facet == Facet::Shaft) host_.shafts.motion[c.host_index] = Motion::Static;
    }
    erase(component);
    sort_by_id();
}

Result<void> World::exchange(std::uint32_t component, const model::ComponentSpec& spec)
{
    auto table_index = table_for(spec.type);
    if (!table_index) return table_index.errors();
    Table& table = *tables_[*table_index];
    note(component);
    const Component old = directory_->components[component];
    const HostRow host_before(host_, old.facet, old.host_index);
    const Materials materials_before = host_.materials;

    count_change(table.type());
    Component next = old;
    next.table = *table_index;
    next.row = table.add(component, old.host_index);
    next.commands = enabled_commands(table.type(), spec);
    next.quarantined = false;
    fill_fields(table, next.row, spec);
    directory_.edit().components[component] = next;
    bind(component, spec);
    if (auto done = prepare(component); !done)
    {
        table.remove(next.row);
        directory_.edit().components[component] = old;
        host_before.restore(host_);
        host_.materials = materials_before;
        return done.errors();
    }
    parked_.push_back({old.table, old.row, kNoIndex, old.facet});
    tables_[old.table]->assign(old.row, kNoIndex, kNoIndex);
    const std::size_t place = scene_->position_of(spec.id, component);
    if (place == scene_->components.size()) return {};
    if (undo_) undo_->specs.push_back({place, scene_->components.share(place)});
    scene_.edit().components.replace(place, spec);
    return {};
}

void World::release_parked()
{
    for (const Parked& p : parked_)
    {
        tables_[p.table]->remove(p.row);
        if (p.host_index != kNoIndex) host_.remove(p.facet, p.host_index);
    }
    parked_.clear();
}

Backup World::backup() const
{
    ByteWriter cells;
    for (const Component& c : components())
        if (c.alive && c.table != kNoIndex) tables_[c.table]->save(c.row, kLiveKinds, cells);
    return {directory_, scene_, parked_, host_, cells.bytes()};
}

void World::save_fields(unsigned kinds, ByteWriter& out) const
{
    for (const auto& table : tables_)
    {
        if (!table->holds(kinds)) continue;
        const auto owners = table->component_of_row();
        for (Row row = 0; row < owners.size(); ++row)
            if (owners[row] != kNoIndex) table->save(row, kinds, out);
    }
}

void World::load_fields(unsigned kinds, ByteReader& in)
{
    for (const auto& table : tables_)
    {
        if (!table->holds(kinds)) continue;
        const auto owners = table->component_of_row();
        for (Row row = 0; row < owners.size(); ++row)
            if (owners[row] != kNoIndex) table->load(row, kinds, in);
    }
}

void World::restore(const Backup& b)
{
    ++revisions_.others, ++revisions_.contacts;
    const bool same_structure = directory_.same_as(b.directory) && scene_.same_as(b.scene);
    if (!same_structure) restore_structure(b);
    host_ = b.host;
    ByteReader cells(b.cells);
    for (const Component& c : components())
        if (c.alive && c.table != kNoIndex) tables_[c.table]->load(c.row, kLiveKinds, cells);
    if (same_structure) return;
    for (const model::ComponentSpec& spec : scene_->components)
        if (const std::uint32_t i = find(spec.id); i != kNoIndex && component(i).table != kNoIndex) bind(i, spec);
}

void World::restore_structure(const Backup& b)
{
    // Rows that were added since the backup are removed; rows that were parked since are restored.
    for (const Component& c : components())
        if (c.alive && c.table != kNoIndex) tables_[c.table]->assign(c.row, kNoIndex, kNoIndex);
    const Shared<Directory> newer = directory_;
    directory_ = b.directory, scene_ = b.scene;
    for (std::uint32_t i = 0; i < components().size(); ++i)
        if (const Component& c = component(i); c.alive && c.table != kNoIndex) tables_[c.table]->assign(c.row, i, c.host_index);
    for (const Component& c : newer->components)
        if (c.alive && c.table != kNoIndex && tables_[c.table]->component_of_row()[c.row] == kNoIndex) tables_[c.table]->remove(c.row);
    // Components that were added and removed since the backup are parked without an owner: their rows are freed. Their host rows have
    // disappeared with the restored host tables; freeing them later would free the row of whichever component has that index by then.
    for (const Parked& p : parked_)
        if (tables_[p.table]->component_of_row()[p.row] == kNoIndex && std::find(b.parked.begin(), b.parked.end(), p) == b.parked.end())
            tables_[p.table]->remove(p.row);
    parked_ = b.parked;
    sort_by_id();
}

}  // namespace plab::world
