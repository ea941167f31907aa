#include "sites.h"

#include <cmath>

namespace plab::rules
{
namespace
{

double number(const Lookup& lookup, Ref ref, std::string_view field)
{
    const Value value = lookup.value_of(ref, field);
    const double* number = std::get_if<double>(&value);
    return number ? *number : 0.0;
}

/// Of the connector, or of the object's shape.
double radius_of(const Lookup& lookup, std::uint32_t object, Ref connector)
{
    if (connector.valid())
        if (const double own = number(lookup, connector, "radius"); own > 0) return own;
    const Ref shape = lookup.participant(object, "shape");
    for (const char* const field : {"pitch_radius", "radius"})
        if (const double r = number(lookup, shape, field); r > 0) return r;
    return 0;
}

std::string kind_of(const Lookup& lookup, Ref connector)
{
    const Value kind = lookup.value_of(connector, "kind");
    return std::get<std::string>(kind);
}

bool matches(const Lookup& lookup, const Wanted& wanted, std::uint32_t object, Ref connector)
{
    if (connector.valid() != !wanted.connector.empty()) return false;
    if (!lookup.matches(wanted.ids, lookup.id_of(object))) return false;
    if (!wanted.type.empty() && !lookup.matches(wanted.type, lookup.type_of(object))) return false;
    if (!wanted.shape.empty())
    {
        const Ref shape = lookup.participant(object, "shape");
        if (!shape.valid() || !lookup.matches(wanted.shape, lookup.type_of(lookup.component_of(shape)))) return false;
    }
    return !connector.valid() || lookup.matches(wanted.connector, kind_of(lookup, connector));
}

}  // namespace

std::vector<Site> find_sites(const Lookup& lookup, const Wanted& a, const Wanted& b)
{
    std::vector<Site> out;
    for (const std::uint32_t component : lookup.components())
    {
        Site site;
        site.component = component;
        const Ref ref = lookup.ref_of(component);
        const bool is_object = ref.facet == Facet::Body || ref.facet == Facet::Shaft;
        if (!is_object && lookup.type_of(component) != "Connector/Frame") continue;
        if (!is_object) site.connector = ref;
        site.object = is_object ? ref : lookup.participant(component, "object");
        const std::uint32_t object = lookup.component_of(site.object);
        site.is_a = matches(lookup, a, object, site.connector), site.is_b = matches(lookup, b, object, site.connector);
        if (!site.is_a && !site.is_b) continue;
        if (!is_object)
        {
            const Value position = lookup.value_of(ref, "position"), orientation = lookup.value_of(ref, "orientation");
            site.tolerance = number(lookup, ref, "tolerance");
            site.offset = {std::get<Vec3>(position), std::get<Quat>(orientation)};
        }
        site.radius = radius_of(lookup, object, site.connector);
        out.push_back(site);
    }
    return out;
}

namespace
{

Pose frame_of(Ref object, const Bodies& bodies, const Shafts& shafts)
{
    if (object.facet == Facet::Body) return bodies.pose(object.index);
    const double half = 0.5 * shafts.angle[object.index];
    return shafts.axle[object.index] * Pose{{}, {std::cos(half), 0, 0, std::sin(half)}};
}

}  // namespace

Place place_of(const Site& site, const Bodies& bodies, const Shafts& shafts)
{
    return {frame_of(site.object, bodies, shafts) * site.offset, site.radius};
}

Vec3 origin_of(const Site& site, const Bodies& bodies, const Shafts& shafts)
{
    const std::uint32_t i = site.object.index;
    if (site.object.facet == Facet::Body)
    {
        const Vec3 from_center = site.offset.p - bodies.center_B[i];
        return from_center == Vec3{} ? bodies.position[i] : bodies.position[i] + rotate(bodies.orientation[i], from_center);
    }
    return site.offset.p == Vec3{} ? shafts.axle[i].p : frame_of(site.object, bodies, shafts) * site.offset.p;
}

Vec3 spin_of(const Site& site, const Bodies& bodies, const Shafts& shafts)
{
    const std::uint32_t i = site.object.index;
    return site.object.facet == Facet::Body ? bodies.angular_velocity[i] : shafts.speed[i] * shafts.axis_W(i);
}

Vec3 velocity_of(const Site& site, const Bodies& bodies, const Shafts& shafts)
{
    const Vec3 p = origin_of(site, bodies, shafts);
    const std::uint32_t i = site.object.index;
    if (site.object.facet == Facet::Body) return bodies.velocity_at(i, p);
    return cross(spin_of(site, bodies, shafts), p - shafts.axle[i].p);
}

bool is_dynamic(const Site& site, const Bodies& bodies, const Shafts& shafts)
{
    const std::uint32_t i = site.object.index;
    return site.object.facet == Facet::Body ? bodies.dynamic(i) : shafts.dynamic(i);
}

}  // namespace plab::rules
