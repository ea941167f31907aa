#include "world/image.h"

#include <cassert>

namespace plab::world
{
namespace
{

Bodies without_shapes(const Bodies& b)
{
    Bodies out;
    out.motion = b.motion, out.position = b.position, out.orientation = b.orientation, out.velocity = b.velocity;
    out.angular_velocity = b.angular_velocity, out.angular_momentum = b.angular_momentum;
    out.mass = b.mass, out.inverse_mass = b.inverse_mass, out.needle = b.needle;
    out.inertia_B = b.inertia_B, out.inverse_inertia_B = b.inverse_inertia_B, out.center_B = b.center_B;
    return out;
}

Shafts without_shapes(const Shafts& s)
{
    Shafts out;
    out.motion = s.motion, out.angle = s.angle, out.speed = s.speed, out.inertia = s.inertia, out.inverse_inertia = s.inverse_inertia;
    out.root = s.root, out.ratio = s.ratio, out.anchor = s.anchor, out.root_anchor = s.root_anchor;
    return out;
}

void load_body(const Bodies& from, std::uint32_t i, Bodies& to, std::uint32_t k)
{
    to.motion[k] = from.motion[i], to.position[k] = from.position[i], to.orientation[k] = from.orientation[i];
    to.velocity[k] = from.velocity[i], to.angular_velocity[k] = from.angular_velocity[i];
    to.angular_momentum[k] = from.angular_momentum[i];
    to.mass[k] = from.mass[i], to.inverse_mass[k] = from.inverse_mass[i], to.needle[k] = from.needle[i];
    to.inertia_B[k] = from.inertia_B[i], to.inverse_inertia_B[k] = from.inverse_inertia_B[i], to.center_B[k] = from.center_B[i];
}

void load_shaft(const Shafts& from, std::uint32_t i, Shafts& to, std::uint32_t k, std::uint32_t root)
{
    to.motion[k] = from.motion[i], to.angle[k] = from.angle[i], to.speed[k] = from.speed[i];
    to.inertia[k] = from.inertia[i], to.inverse_inertia[k] = from.inverse_inertia[i];
    to.root[k] = root == kNoIndex ? k : root, to.ratio[k] = from.ratio[i], to.anchor[k] = from.anchor[i],
    to.root_anchor[k] = from.root_anchor[i];
}

/// The columns of a live table for the fields of a layout, or the reason why one does not fit.
Result<std::vector<ColumnBase*>> columns_for(const Layout& layout, const Table& table)
{
    std::vector<ColumnBase*> out;
    for (const FieldLayout& field : layout.fields)
    {
        const Field* live = table.schema().find_field(field.name);
        const std::string what = layout.type + ": the snapshot's field '" + field.name + "'";
        if (!live || live->hosted || !(kLiveKinds & kind_bit(live->kind))) return reason(what + " is unknown to this build of the type");
        if (live->type != field.type) return reason(what + " has another type in this build");
        out.push_back(live->column);
    }
    return out;
}

}  // namespace

Image World::image() const
{
    Image out;
    out.directory = directory_.lend(), out.scene = scene_.lend();
    (void)out.directory->index_of_id.lend();
    out.layouts.reserve(tables_.size());
    for (const auto& table : tables_) out.layouts.push_back(table->layout());
    ByteWriter cells;
    for (const Component& c : components())
        if (c.alive && c.table != kNoIndex) tables_[c.table]->save(c.row, kLiveKinds, cells);
    out.cells = cells.bytes();
    out.bodies = without_shapes(host_.bodies), out.shafts = without_shapes(host_.shafts), out.quantities = host_.quantities;
    return out;
}

Result<void> World::revive(const Image& image)
{
    assert(components().empty());
    scene_.edit() = *image.scene;
    Errors errors;
    (void)create_from(0, errors);
    if (!errors.empty()) return errors;
    // Values are loaded before Prepare, which uses them, and again afterwards, because Prepare may overwrite some.
    load_cells(image, errors);
    if (!errors.empty()) return errors;
    for (const std::uint32_t i : in_id_order_)
        if (component(i).table != kNoIndex) initialize_motion(i);
    load_host(image);
    if (auto prepared = prepare_all(); !prepared) return prepared;
    refresh_open_roles();
    load_cells(image, errors);
    load_host(image);
    image.for_each([&](std::uint32_t, const Component& c, const Layout&) { quarantine(find(c.id), c.quarantined); });
    if (!errors.empty()) return errors;
    return {};
}

void World::load_cells(const Image& image, Errors& errors)
{
    std::vector<std::vector<ColumnBase*>> columns(image.layouts.size());
    std::vector<std::uint8_t> known(image.layouts.size(), 0);
    ByteReader cells(image.cells);
    image.for_each(
        [&](std::uint32_t, const Component& old, const Layout& layout)
        {
            const std::uint32_t i = find(old.id);
            const bool same = i != kNoIndex && component(i).table != kNoIndex && type_of(i)->info.name == layout.type;
            if (!errors.empty()) return;
            if (!same) return errors.push_back({{}, old.id, "has values as a " + layout.type + " in the snapshot, but not in its scene"});
            if (!known[old.table])
            {
                auto found = columns_for(layout, table_of(i));
                if (!found) return errors.push_back(found.error());
                columns[old.table] = found.take(), known[old.table] = 1;
            }
            for (ColumnBase* column : columns[old.table]) column->load(component(i).row, cells);
        });
}

void World::load_host(const Image& image)
{
    ++revisions_.others, ++revisions_.contacts;
    const Renumbering now(image, *this);
    image.for_each(
        [&](std::uint32_t, const Component& old, const Layout&)
        {
            const std::uint32_t row = component(find(old.id)).host_index;
            if (old.facet == Facet::Body) load_body(image.bodies, old.host_index, host_.bodies, row);
            if (old.facet == Facet::Shaft)
                load_shaft(image.shafts, old.host_index, host_.shafts, row, now.shaft(image.shafts.root[old.host_index]));
            if (old.facet == Facet::Quantities) host_.quantities.value[row] = image.quantities.value[old.host_index];
        });
}

Renumbering::Renumbering(const Image& image, const World& world)
    : component_(image.directory->components.size(), kNoIndex), body_(image.bodies.size(), kNoIndex), shaft_(image.shafts.size(), kNoIndex)
{
    for (std::uint32_t i = 0; i < component_.size(); ++i)
    {
        const Component& old = image.component(i);
        const std::uint32_t now = old.alive ? world.find(old.id) : kNoIndex;
        component_[i] = now;
        if (now == kNoIndex || world.component(now).facet != old.facet) continue;
        if (old.facet == Facet::Body) body_[old.host_index] = world.component(now).host_index;
        if (old.facet == Facet::Shaft) shaft_[old.host_index] = world.component(now).host_index;
    }
}

Ref Renumbering::ref(Ref old) const
{
    if (old.facet == Facet::Body) return {old.facet, body(old.index)};
    if (old.facet == Facet::Shaft) return {old.facet, shaft(old.index)};
    return {old.facet, component(old.index)};
}

namespace
{

template <class T>
Value read_as(ByteReader& in)
{
    T value{};
    read(in, value);
    return Value(std::in_place_type<T>, std::move(value));
}

}  // namespace

void write_value(ByteWriter& out, const Value& value)
{
    std::visit(
        [&](const auto& v)
        {
            if constexpr (!std::is_same_v<std::decay_t<decltype(v)>, std::monostate>) write(out, v);
        },
        value);
}

bool same_bits(const Value& a, const Value& b)
{
    if (a.index() != b.index()) return false;
    ByteWriter x, y;
    write_value(x, a), write_value(y, b);
    return x.bytes() == y.bytes();
}

Value read_value(ByteReader& in, FieldType type)
{
    switch (type)
    {
        case FieldType::Boolean:
            return read_as<bool>(in);
        case FieldType::Integer:
            return read_as<std::int64_t>(in);
        case FieldType::Real:
            return read_as<double>(in);
        case FieldType::Vector:
            return read_as<Vec3>(in);
        case FieldType::Rotation:
            return read_as<Quat>(in);
        case FieldType::Matrix:
            return read_as<Mat3>(in);
        case FieldType::Text:
            return read_as<std::string>(in);
        case FieldType::RealList:
            return read_as<Reals>(in);
        case FieldType::IntegerList:
            return read_as<Integers>(in);
        case FieldType::EntryList:
            return read_as<Entries>(in);
        case FieldType::None:
        case FieldType::Opaque:
            break;
    }
    return {};
}

}  // namespace plab::world
