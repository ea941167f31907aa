#include <algorithm>
#include <cmath>
#include <cstring>

#include "model/alike.h"
#include "world/command_call.h"
#include "world/state_hash.h"
#include "world/world.h"

namespace plab::world
{

std::uint32_t World::find(const std::string& id) const
{
    const std::map<std::string, std::uint32_t>& index = *directory_->index_of_id;
    const auto found = index.find(id);
    return found == index.end() ? kNoIndex : found->second;
}

const std::string& World::id_of(std::uint32_t component) const
{
    static const std::string no_id;
    return component < components().size() ? directory_->components[component].id : no_id;
}

const model::ComponentType* World::type_of(std::uint32_t component) const
{
    const Component& c = directory_->components[component];
    return c.table == kNoIndex ? nullptr : &tables_[c.table]->type();
}

std::vector<Ref> World::participants(std::uint32_t component, const Role& role) const
{
    const Row row = directory_->components[component].row;
    if (role.many) return (*role.many)[row];
    const Ref ref = (*role.one)[row];
    return ref.valid() ? std::vector<Ref>{ref} : std::vector<Ref>{};
}

/// The columns of roles say quickly who may refer to it; whether that is by name, and not by "*" or a pattern, is written in the scene.
std::vector<std::uint32_t> World::referrers(std::uint32_t component) const
{
    const Component& c = directory_->components[component];
    if (c.table == kNoIndex) return {};
    const Ref wanted = c.ref(component);
    std::vector<std::pair<std::size_t, std::uint32_t>> found;  // by place in the scene
    const auto add = [&](std::uint32_t referrer)
    {
        const std::size_t place = scene_->position_of(id_of(referrer), referrer);
        if (place == scene_->components.size()) return;
        for (const model::RoleSpec& role : scene_->components[place].roles)
        {
            const std::vector<std::string>& named = role.everyone ? role.patterns : role.members;
            if (std::find(named.begin(), named.end(), c.id) != named.end()) return (void)found.emplace_back(place, referrer);
        }
    };
    for (const auto& table : tables_)
        for (const Role& role : table->schema().roles())
        {
            if (std::find(role.facets.begin(), role.facets.end(), wanted.facet) == role.facets.end()) continue;
            const auto owners = table->component_of_row();
            for (Row row = 0; row < owners.size(); ++row)
            {
                if (owners[row] == kNoIndex) continue;
                const bool refers = role.many
                                        ? std::find((*role.many)[row].begin(), (*role.many)[row].end(), wanted) != (*role.many)[row].end()
                                        : (*role.one)[row] == wanted;
                if (refers) add(owners[row]);
            }
        }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    std::vector<std::uint32_t> out;
    for (const auto& [place, referrer] : found) out.push_back(referrer);
    return out;
}

Value World::get(std::uint32_t component, const std::string& name) const
{
    const Component& c = directory_->components[component];
    if (c.table == kNoIndex) return {};
    const Table& table = *tables_[c.table];
    if (const Field* field = table.schema().find_field(name))
        return field->hosted ? get_hosted(host_, c.facet, c.host_index, name) : field->column->get(c.row);
    const std::size_t dot = name.find('.');
    const Field* record = dot == std::string::npos ? nullptr : table.schema().find_field(name.substr(0, dot));
    if (!record || record->type != FieldType::EntryList) return {};
    const Value cell = record->column->get(c.row);
    for (const Entry& entry : std::get<Entries>(cell))
        if (entry.name == name.substr(dot + 1)) return std::visit([](const auto& v) { return Value(v); }, entry.value);
    return {};
}

Result<void> World::set(std::uint32_t component, const std::string& name, const Value& value)
{
    const Component& c = directory_->components[component];
    if (c.table == kNoIndex) return reason("is a group");
    const Table& table = *tables_[c.table];
    const Field* field = table.schema().find_field(name);
    if (!field) return reason("has no field '" + name + "'");
    if (field->kind == FieldKind::Output || field->kind == FieldKind::Scratch)
        return reason("'" + name + "' is computed, it cannot be set");
    if (plab::type_of(value) != field->type) return reason("'" + name + "' has another type");
    note(component);
    if (field->hosted)
        set_hosted(host_, c.facet, c.host_index, name, value);
    else
        field->column->set(c.row, value);
    return {};
}

int World::prepare_order(std::uint32_t component) const
{
    constexpr int kDeepest = 5, kBodies = kDeepest + 2, kOthers = kBodies + 1;
    const Component& c = directory_->components[component];
    if (c.table == kNoIndex) return 0;
    if (c.facet != Facet::Shape) return c.facet == Facet::Component ? kOthers : kBodies;
    // A shape comes after those to which it refers. Where they refer to one another in a circle, none can be prepared anyway.
    const auto depth_of = [&](const auto& self, std::uint32_t shape, int left) -> int
    {
        int depth = 0;
        for (const Role& role : tables_[directory_->components[shape].table]->schema().roles())
            if (left > 0 && role.facets.size() == 1 && role.facets.front() == Facet::Shape)
                for_each_participant(shape, role, [&](Ref r) { depth = std::max(depth, self(self, host_.component_of(r), left - 1)); });
        return depth + 1;
    };
    return depth_of(depth_of, component, kDeepest);
}

Result<void> World::run(std::uint32_t component, Phase phase)
{
    const Component& c = directory_->components[component];
    CommandCall call;
    call.context.seed = scene_->settings.seed;
    call.arguments.bodies = &host_.bodies, call.arguments.shafts = &host_.shafts, call.arguments.quantities = &host_.quantities;
    call.arguments.shapes = &host_.shapes, call.arguments.materials = &host_.materials;
    if (phase == Phase::Measure) call.arguments.solid = &host_.shapes.solid[c.host_index];
    call.select(*tables_[c.table]);
    return call.run(phase, Rows(&c.row, 1));
}

namespace
{

/// trace^3 / det is 27 for a sphere and grows with the spread of the principal inertias.
bool is_needle(const Mat3& inertia)
{
    const double trace = inertia(0, 0) + inertia(1, 1) + inertia(2, 2);
    return trace * trace * trace > 1e4 * determinant(inertia);
}

}  // namespace

Result<void> World::prepare(std::uint32_t component)
{
    const Component& c = directory_->components[component];
    if (c.table == kNoIndex) return {};
    note(component);
    auto done = run(component, Phase::Prepare);
    if (done && c.facet == Facet::Body)
        host_.bodies.needle[c.host_index] = host_.bodies.dynamic(c.host_index) && is_needle(host_.bodies.inertia_B[c.host_index]) ? 1 : 0;
    if (done && c.facet == Facet::Shape)
    {
        // A shape without a volume may still be drawn; only a body that needs its mass reports an error.
        const auto measured = run(component, Phase::Measure);
        host_.shapes.unmeasurable[c.host_index] = measured ? std::string() : measured.error().reason;
    }
    if (done) return {};
    Errors errors = done.errors();
    const model::ComponentSpec* spec = scene_->find(c.id);
    for (Error& e : errors)
    {
        if (e.element.empty()) e.element = c.id + " (" + tables_[c.table]->type().info.name + ")";
        if (e.where.file.empty() && spec) e.where = spec->where;
    }
    return errors;
}

Result<void> World::prepare_all()
{
    std::vector<std::pair<int, std::uint32_t>> order;
    order.reserve(in_id_order_.size());
    for (const std::uint32_t i : in_id_order_) order.emplace_back(prepare_order(i), i);
    std::ranges::stable_sort(order, {}, &std::pair<int, std::uint32_t>::first);
    Errors errors;
    for (const auto& [rank, i] : order)
        if (auto done = prepare(i); !done) errors.insert(errors.end(), done.errors().begin(), done.errors().end());
    if (errors.empty()) return {};
    return model::first_of_alike(std::move(errors));
}

void World::save_state(std::uint32_t component, ByteWriter& out) const
{
    const Component& c = directory_->components[component];
    if (c.table == kNoIndex) return;
    tables_[c.table]->save(c.row, kStateKinds, out);
    if (c.host_index != kNoIndex) plab::world::save_state(host_, c.ref(component), out);
}

namespace
{

/// Hash of the values that save_state() writes for a body, column by column.
std::uint64_t hash_of_body(const Bodies& b, std::uint32_t i)
{
    const std::uint64_t place = mix(hash_of(b.position[i]), hash_of(b.orientation[i]));
    const std::uint64_t speed = mix(hash_of(b.velocity[i]), hash_of(b.angular_velocity[i]));
    return mix(mix(place, speed), hash_of(b.angular_momentum[i]));
}

}  // namespace

/// Short independent chains: a processor works on several at once, whereas a single chain through all bytes would wait for each product.
/// Recordings compute this hash at each step.
std::uint64_t World::state_hash(std::uint64_t h) const
{
    std::vector<std::uint8_t> has_state(tables_.size());
    for (std::size_t t = 0; t < tables_.size(); ++t)
        for (const Field& field : tables_[t]->schema().fields())
            if (field.kind == FieldKind::State && !field.hosted) has_state[t] = 1;
    ByteWriter bytes;
    for (const std::uint32_t i : in_id_order_)
    {
        const Component& c = directory_->components[i];
        if (c.table == kNoIndex) continue;
        if (c.facet == Facet::Body && c.host_index != kNoIndex && !has_state[c.table])
        {
            h = mix(h, hash_of_body(host_.bodies, c.host_index));
            continue;
        }
        bytes.clear();
        if (has_state[c.table]) tables_[c.table]->save(c.row, kStateKinds, bytes);
        if (c.host_index != kNoIndex) plab::world::save_state(host_, c.ref(i), bytes);
        if (!bytes.bytes().empty()) h = mix(h, hash_bytes(0, bytes.bytes()));
    }
    return h;
}

std::uint64_t hash_bytes(std::uint64_t h, std::span<const std::uint8_t> bytes)
{
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8)
    {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + i, 8);
        h = mix(h, word);
    }
    for (; i < bytes.size(); ++i) h = (h ^ bytes[i]) * kHashPrime;
    return h;
}

double World::largest_error(std::uint32_t i) const
{
    double worst = 0;
    if (component(i).table == kNoIndex) return worst;
    for (const Field& field : table_of(i).schema().fields())
        if (const auto* column = field.is_error ? dynamic_cast<const Column<double>*>(field.column) : nullptr)
            worst = std::max(worst, std::fabs((*column)[component(i).row]));
    return worst;
}

}  // namespace plab::world
