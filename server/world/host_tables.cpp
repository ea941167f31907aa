#include "world/host_tables.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace plab::world
{
namespace
{

template <class Grow>
std::uint32_t take_row(std::vector<std::uint32_t>& free, std::vector<std::uint32_t>& owners, std::uint32_t component, Grow grow)
{
    std::uint32_t i = 0;
    if (free.empty())
    {
        i = static_cast<std::uint32_t>(owners.size());
        owners.push_back(component);
        grow(owners.size());
    }
    else
    {
        i = free.back();
        free.pop_back();
        owners[i] = component;
    }
    return i;
}

void resize(Bodies& b, std::size_t n)
{
    b.motion.resize(n, Motion::Static), b.position.resize(n), b.orientation.resize(n), b.velocity.resize(n);
    b.angular_velocity.resize(n), b.angular_momentum.resize(n), b.mass.resize(n), b.inverse_mass.resize(n);
    b.inertia_B.resize(n), b.inverse_inertia_B.resize(n), b.center_B.resize(n), b.needle.resize(n), b.material.resize(n),
        b.shapes.resize(n);
}

void clear_row(Bodies& b, std::uint32_t i)
{
    b.motion[i] = Motion::Static, b.position[i] = {}, b.orientation[i] = {}, b.velocity[i] = {};
    b.angular_velocity[i] = {}, b.angular_momentum[i] = {}, b.mass[i] = 0, b.inverse_mass[i] = 0;
    b.inertia_B[i] = {}, b.inverse_inertia_B[i] = {}, b.center_B[i] = {}, b.needle[i] = 0, b.material[i] = 0, b.shapes[i].clear();
}

void resize(Shafts& s, std::size_t n)
{
    s.motion.resize(n, Motion::Static), s.angle.resize(n), s.speed.resize(n), s.inertia.resize(n);
    s.inverse_inertia.resize(n), s.axle.resize(n), s.shapes.resize(n);
    s.root.resize(n), s.ratio.resize(n, 1.0), s.anchor.resize(n), s.root_anchor.resize(n);
}

void clear_row(Shafts& s, std::uint32_t i)
{
    s.motion[i] = Motion::Static, s.angle[i] = 0, s.speed[i] = 0, s.inertia[i] = 0, s.inverse_inertia[i] = 0;
    s.axle[i] = {}, s.shapes[i].clear(), s.root[i] = i, s.ratio[i] = 1, s.anchor[i] = 0, s.root_anchor[i] = 0;
}

/// The motion of a body as the author of the scene sees it: the frame B, the velocity of its origin, and the spin.
struct BodyMotion
{
    Vec3 position;
    Quat orientation;
    Vec3 velocity;
    Vec3 spin;
};

BodyMotion authored_motion(const Bodies& b, std::uint32_t i)
{
    BodyMotion m{b.position[i], b.orientation[i], b.velocity[i], b.angular_velocity[i]};
    if (b.center_B[i] == Vec3{}) return m;
    const Vec3 p_BC_W = rotate(b.orientation[i], b.center_B[i]);
    m.position = b.position[i] - p_BC_W;
    m.velocity = b.velocity[i] - cross(b.angular_velocity[i], p_BC_W);
    return m;
}

void set_authored_motion(Bodies& b, std::uint32_t i, const BodyMotion& m)
{
    b.orientation[i] = m.orientation;
    b.angular_velocity[i] = m.spin;
    b.position[i] = m.position;
    b.velocity[i] = m.velocity;
    if (b.center_B[i] != Vec3{})
    {
        const Vec3 p_BC_W = rotate(m.orientation, b.center_B[i]);
        b.position[i] += p_BC_W;
        b.velocity[i] += cross(m.spin, p_BC_W);
    }
    if (b.dynamic(i)) b.refresh_momentum(i);
}

bool set_body(Bodies& b, std::uint32_t i, std::string_view name, const Value& value)
{
    BodyMotion m = authored_motion(b, i);
    if (name == "position")
        m.position = std::get<Vec3>(value);
    else if (name == "orientation")
        m.orientation = std::get<Quat>(value);
    else if (name == "linear_velocity")
        m.velocity = std::get<Vec3>(value);
    else if (name == "angular_velocity")
        m.spin = std::get<Vec3>(value);
    else
        return false;
    // Only a rotation changes the angular momentum of a body; a translation must not change the last bit of its spin.
    const Vec3 momentum = b.angular_momentum[i];
    set_authored_motion(b, i, m);
    if (name == "position" || name == "linear_velocity") b.angular_momentum[i] = momentum;
    return true;
}

}  // namespace

std::uint32_t HostTables::add(Facet facet, std::uint32_t component)
{
    std::uint32_t i = kNoIndex;
    if (facet == Facet::Body)
    {
        i = take_row(free_bodies, component_of_body, component, [&](std::size_t n) { resize(bodies, n); });
        clear_row(bodies, i);
    }
    if (facet == Facet::Shaft)
    {
        i = take_row(free_shafts, component_of_shaft, component, [&](std::size_t n) { resize(shafts, n); });
        clear_row(shafts, i);
    }
    if (facet == Facet::Shape)
    {
        i = take_row(free_shapes, component_of_shape, component,
                     [&](std::size_t n) { shapes.geometry.resize(n), shapes.solid.resize(n), shapes.unmeasurable.resize(n); });
        shapes.geometry[i] = {}, shapes.solid[i] = {}, shapes.unmeasurable[i] = {};
    }
    if (facet == Facet::Quantities)
    {
        i = take_row(free_quantities, component_of_quantities, component, [&](std::size_t n) { quantities.value.resize(n); });
        quantities.value[i].clear();
    }
    return i;
}

void HostTables::remove(Facet facet, std::uint32_t index)
{
    if (facet == Facet::Body) clear_row(bodies, index), component_of_body[index] = kNoIndex, free_bodies.push_back(index);
    if (facet == Facet::Shaft) clear_row(shafts, index), component_of_shaft[index] = kNoIndex, free_shafts.push_back(index);
    if (facet == Facet::Shape)
    {
        shapes.geometry[index] = {}, shapes.solid[index] = {}, shapes.unmeasurable[index] = {};
        component_of_shape[index] = kNoIndex, free_shapes.push_back(index);
    }
    if (facet == Facet::Quantities)
        quantities.value[index].clear(), component_of_quantities[index] = kNoIndex, free_quantities.push_back(index);
}

void HostTables::disown(Facet facet, std::uint32_t index)
{
    if (facet == Facet::Body) component_of_body[index] = kNoIndex;
    if (facet == Facet::Shaft) component_of_shaft[index] = kNoIndex;
    if (facet == Facet::Shape) component_of_shape[index] = kNoIndex;
    if (facet == Facet::Quantities) component_of_quantities[index] = kNoIndex;
}

Value get_hosted(const HostTables& t, Facet facet, std::uint32_t i, std::string_view name)
{
    if (facet == Facet::Shaft)
    {
        if (name == "angle") return t.shafts.angle[i];
        if (name == "angular_velocity") return t.shafts.speed[i];
    }
    if (facet == Facet::Quantities && name == "values") return Value(std::in_place_type<Reals>, t.quantities.value[i]);
    if (facet != Facet::Body) return {};
    const BodyMotion m = authored_motion(t.bodies, i);
    if (name == "position") return m.position;
    if (name == "orientation") return m.orientation;
    if (name == "linear_velocity") return m.velocity;
    if (name == "angular_velocity") return m.spin;
    return {};
}

bool set_hosted(HostTables& t, Facet facet, std::uint32_t i, std::string_view name, const Value& value)
{
    if (facet == Facet::Body) return set_body(t.bodies, i, name, value);
    if (facet == Facet::Quantities && name == "values") return t.quantities.value[i] = std::get<Reals>(value), true;
    if (facet != Facet::Shaft) return false;
    if (name == "angle")
        t.shafts.angle[i] = std::get<double>(value);
    else if (name == "angular_velocity")
        t.shafts.speed[i] = std::get<double>(value);
    else
        return false;
    return true;
}

void save_state(const HostTables& t, Ref ref, ByteWriter& out)
{
    const std::uint32_t i = ref.index;
    if (ref.facet == Facet::Body)
    {
        write(out, t.bodies.position[i]);
        write(out, t.bodies.orientation[i]);
        write(out, t.bodies.velocity[i]);
        write(out, t.bodies.angular_velocity[i]);
        write(out, t.bodies.angular_momentum[i]);
    }
    if (ref.facet == Facet::Shaft)
    {
        write(out, t.shafts.angle[i]);
        write(out, t.shafts.speed[i]);
    }
    if (ref.facet == Facet::Quantities) write(out, t.quantities.value[i]);
}

void MotionMemento::save(const HostTables& t)
{
    some_ = false;
    position_ = t.bodies.position, velocity_ = t.bodies.velocity, orientation_ = t.bodies.orientation;
    angular_velocity_ = t.bodies.angular_velocity, angular_momentum_ = t.bodies.angular_momentum;
    angle_ = t.shafts.angle, speed_ = t.shafts.speed;
    anchor_ = t.shafts.anchor, root_anchor_ = t.shafts.root_anchor;
    quantities_ = t.quantities.value;
}

void MotionMemento::save_some(const HostTables& t, std::span<const std::uint32_t> bodies)
{
    assert(!some_ && position_.size() == t.bodies.size());
    for (const std::uint32_t b : bodies) save_body(t, b);
    angle_ = t.shafts.angle, speed_ = t.shafts.speed;
    anchor_ = t.shafts.anchor, root_anchor_ = t.shafts.root_anchor;
    quantities_ = t.quantities.value;
}

void MotionMemento::resize(std::size_t bodies, std::size_t shafts, std::size_t quantities)
{
    position_.resize(bodies), velocity_.resize(bodies), orientation_.resize(bodies);
    angular_velocity_.resize(bodies), angular_momentum_.resize(bodies);
    angle_.resize(shafts), speed_.resize(shafts), anchor_.resize(shafts), root_anchor_.resize(shafts);
    quantities_.resize(quantities);
}

void MotionMemento::fit(const HostTables& t)
{
    some_ = false;
    resize(t.bodies.size(), t.shafts.size(), t.quantities.size());
}

void MotionMemento::fit_rows(std::vector<std::uint32_t> bodies, std::vector<std::uint32_t> shafts, std::vector<std::uint32_t> quantities)
{
    some_ = true;
    bodies_ = std::move(bodies), shafts_ = std::move(shafts), quantity_rows_ = std::move(quantities);
    resize(bodies_.size(), shafts_.size(), quantity_rows_.size());
}

std::size_t MotionMemento::place(const std::vector<std::uint32_t>& rows, std::uint32_t row) const
{
    if (!some_) return row;
    const auto at = std::lower_bound(rows.begin(), rows.end(), row);
    assert(at != rows.end() && *at == row);
    return static_cast<std::size_t>(at - rows.begin());
}

void MotionMemento::restore(HostTables& t) const
{
    assert(!some_);
    t.bodies.position = position_, t.bodies.velocity = velocity_, t.bodies.orientation = orientation_;
    t.bodies.angular_velocity = angular_velocity_, t.bodies.angular_momentum = angular_momentum_;
    t.shafts.angle = angle_, t.shafts.speed = speed_;
    t.shafts.anchor = anchor_, t.shafts.root_anchor = root_anchor_;
    t.quantities.value = quantities_;
}

void MotionMemento::save_body(const HostTables& t, std::uint32_t i)
{
    const std::size_t k = place(bodies_, i);
    position_[k] = t.bodies.position[i], velocity_[k] = t.bodies.velocity[i], orientation_[k] = t.bodies.orientation[i];
    angular_velocity_[k] = t.bodies.angular_velocity[i], angular_momentum_[k] = t.bodies.angular_momentum[i];
}

void MotionMemento::save_shaft(const HostTables& t, std::uint32_t i)
{
    const std::size_t k = place(shafts_, i);
    angle_[k] = t.shafts.angle[i], speed_[k] = t.shafts.speed[i];
    anchor_[k] = t.shafts.anchor[i], root_anchor_[k] = t.shafts.root_anchor[i];
}

void MotionMemento::restore_body(HostTables& t, std::uint32_t i) const
{
    const std::size_t k = place(bodies_, i);
    t.bodies.position[i] = position_[k], t.bodies.velocity[i] = velocity_[k], t.bodies.orientation[i] = orientation_[k];
    t.bodies.angular_velocity[i] = angular_velocity_[k], t.bodies.angular_momentum[i] = angular_momentum_[k];
}

void MotionMemento::restore_shaft(HostTables& t, std::uint32_t i) const
{
    const std::size_t k = place(shafts_, i);
    t.shafts.angle[i] = angle_[k], t.shafts.speed[i] = speed_[k];
    t.shafts.anchor[i] = anchor_[k], t.shafts.root_anchor[i] = root_anchor_[k];
}

void MotionMemento::save_quantities(const HostTables& t, std::uint32_t i) { quantities_[place(quantity_rows_, i)] = t.quantities.value[i]; }

void MotionMemento::restore_quantities(HostTables& t, std::uint32_t i) const
{
    t.quantities.value[i] = quantities_[place(quantity_rows_, i)];
}

}  // namespace plab::world
