#include "simulation/contacts/sleep_causes.h"

#include "world/state_hash.h"

namespace plab::simulation
{

using world::hash_of, world::mix;

namespace
{

std::uint64_t hash_of_text(const std::string& text)
{
    return world::hash_bytes(text.size(), {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::uint64_t hash_of_law(const SurfaceLaw* law)
{
    if (!law) return 0;
    const std::uint64_t h = mix(mix(1, law->friction), law->restitution);
    return law->resists_turning() ? mix(mix(h, law->rolling_friction), law->spinning_friction) : h;
}

}  // namespace

void SleepCauses::begin()
{
    known_.assign(step_.world.components().size(), 0);
    pairs_.assign(step_.world.host().bodies.size(), 0);
}

std::uint64_t SleepCauses::of_name(std::uint32_t component) const { return hash_of_text(step_.world.id_of(component)); }

/// Of the parameters, not of what a step may change.
std::uint64_t SleepCauses::of_component(std::uint32_t component)
{
    if (component == kNoIndex) return 0;
    std::uint64_t& known = known_[component];
    if (known != 0) return known;
    const world::Component& c = step_.world.component(component);
    known = mix(mix(of_name(component), c.commands), std::uint64_t{c.quarantined ? 1u : 0u});
    if (c.table != kNoIndex)
    {
        bytes_.clear();
        step_.world.table_of(component).save(c.row, world::kind_bit(FieldKind::Param), bytes_);
        known = mix(mix(known, hash_of_text(step_.world.type_of(component)->info.name)), world::hash_bytes(0, bytes_.bytes()));
    }
    return known = std::max<std::uint64_t>(known, 1);
}

std::uint64_t SleepCauses::of_place(std::uint32_t b)
{
    const world::HostTables& host = step_.world.host();
    const Bodies& bodies = host.bodies;
    std::uint64_t h = mix(of_component(host.component_of({Facet::Body, b})), std::uint64_t(bodies.motion[b]));
    h = mix(mix(h, hash_of(bodies.position[b])), hash_of(bodies.orientation[b]));
    for (const Ref shape : bodies.shapes[b])
    {
        h = mix(h, of_component(host.component_of(shape)));
        for (const std::uint32_t part : host.shapes.geometry[shape.index].parts) h = mix(h, of_component(host.component_of_shape[part]));
    }
    return h;
}

std::uint64_t SleepCauses::of_scene()
{
    const Bodies& bodies = step_.world.host().bodies;
    std::uint64_t fixed = 0;  // a sum, as rows are in no order
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
        if (bodies.motion[b] == Motion::Static && step_.world.host().component_of({Facet::Body, b}) != kNoIndex) fixed += of_place(b);
    std::uint64_t h = mix(0, fixed);
    for (const Detector& d : contacts_.detectors())
        for (const std::uint32_t part : {d.component, d.resolution, d.response, d.manager}) h = mix(h, of_component(part));
    const std::uint64_t filter = of_filter();
    return filter == 0 ? h : mix(h, filter);
}

/// A new exclusion, or one that is gone, concerns all: bodies that now meet did not know of one another.
std::uint64_t SleepCauses::of_filter() const
{
    const world::HostTables& host = step_.world.host();
    const auto of = [&](Facet facet, std::uint32_t i, std::span<const std::uint32_t> marks)
    {
        if (marks.empty()) return std::uint64_t{0};
        std::uint64_t h = of_name(host.component_of({facet, i}));
        for (const std::uint32_t mark : marks) h = mix(h, std::uint64_t{mark});
        return h;
    };
    std::uint64_t sum = 0;  // rows are in no order
    for (std::uint32_t b = 0; b < host.bodies.size(); ++b) sum += of(Facet::Body, b, host.filter.of_body(b));
    for (std::uint32_t s = 0; s < host.shapes.size(); ++s) sum += of(Facet::Shape, s, host.filter.of_shape(s));
    return sum;
}

void SleepCauses::add_pair(const PairState& p)
{
    const Bodies& bodies = step_.world.host().bodies;
    std::uint64_t h = mix(of_name(p.detector), std::uint64_t{p.resting ? 1u : 0u});
    for (const Ref r : {p.a, p.b}) h = mix(h, of_name(step_.world.host().component_of(r)));
    h = mix(h, hash_of_law(step_.world.host().materials.find_pair(bodies.material[p.a.index], bodies.material[p.b.index])));
    for (const Ref r : {p.a, p.b}) pairs_[r.index] += h;
}

std::uint64_t SleepCauses::of_body(std::uint32_t b)
{
    const Bodies& bodies = step_.world.host().bodies;
    std::uint64_t h = mix(of_place(b), pairs_[b]);
    h = mix(mix(h, bodies.mass[b]), hash_of(bodies.center_B[b]));
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) h = mix(h, bodies.inertia_B[b](i, k));
    h = mix(mix(h, hash_of(bodies.velocity[b])), hash_of(bodies.angular_velocity[b]));
    const std::uint32_t g = step_.groups.group_of_body[b];
    if (g == kNoIndex) return 1;
    for (const BlockRow& force : step_.groups.all[g].forces)
        h = mix(h, of_component(step_.world.tables()[step_.schedule.of(Phase::Force)[force.block].table]->component_of_row()[force.row]));
    for (std::uint32_t d = 0; d < contacts_.detectors().size(); ++d) h = mix(h, std::uint64_t{contacts_.takes_part(d, b) ? 1u : 0u});
    return std::max<std::uint64_t>(h, 2);
}

}  // namespace plab::simulation
