#include "study/shadow.h"

#include <algorithm>
#include <cmath>

namespace plab::study
{

using simulation::Simulation;

Result<void> ask_now(Simulation& s, std::vector<simulation::Operation> operations)
{
    simulation::Request request;
    request.trial.budget = simulation::TrialChoice::Budget::None;
    request.operations = std::move(operations);
    const simulation::Reply reply = s.carry_out_now(request);
    if (!reply.done) return reply.errors;
    return {};
}

Result<void> give_all(Simulation& s, const std::vector<std::string>& components, const simulation::Level& level)
{
    std::vector<simulation::Operation> operations;
    for (const std::string& id : components) operations.emplace_back(simulation::SwapOperation{id, level.type, level.values});
    return ask_now(s, std::move(operations));
}

std::vector<ObjectPair> body_pairs(const Simulation& run, const Simulation& shadow)
{
    std::vector<ObjectPair> out;
    for (const std::uint32_t i : run.world().in_id_order())
    {
        const world::Component& c = run.world().component(i);
        if (c.facet != Facet::Body || !run.world().host().bodies.dynamic(c.host_index)) continue;
        if (const std::uint32_t k = shadow.world().find(c.id); k != kNoIndex)
            out.push_back({Facet::Body, c.host_index, shadow.world().component(k).host_index});
    }
    return out;
}

bool find_pair(const Simulation& run, const Simulation& shadow, Ref object, ObjectPair& out)
{
    const std::uint32_t there = shadow.world().find(run.world().id_of(object));
    if (there == kNoIndex) return false;
    out = {object.facet, object.index, shadow.world().component(there).host_index};
    return true;
}

Apart apart(const Simulation& run, const Simulation& shadow, const ObjectPair& p)
{
    if (p.facet == Facet::Shaft)
        return {0, std::fabs(run.world().host().shafts.angle[p.here] - shadow.world().host().shafts.angle[p.there])};
    const Bodies &a = run.world().host().bodies, &b = shadow.world().host().bodies;
    const Quat turn = conjugate(a.orientation[p.here]) * b.orientation[p.there];
    const double angle = 2 * std::atan2(length(Vec3{turn.x, turn.y, turn.z}), std::fabs(turn.w));
    const double radius = run.stepper().radius_of_body()[p.here];
    return {length(a.position[p.here] - b.position[p.there]) + (std::isfinite(radius) ? radius * angle : 0), angle};
}

double pixels_per_metre(const Viewpoint& eye, const Vec3& p)
{
    constexpr double kNearest = 0.5;  // m
    const Vec3 right = normalized(cross(eye.direction, eye.up)), up = cross(right, eye.direction), d = p - eye.position;
    const double tall = std::tan(0.5 * eye.field_of_view), wide = tall * eye.width / eye.height, z = dot(d, eye.direction);
    if (z < kNearest || std::fabs(dot(d, right)) > wide * z || std::fabs(dot(d, up)) > tall * z) return 0;
    return 0.5 * eye.height / tall / z;
}

double pixels_per_metre(const std::vector<Viewpoint>& eyes, const Vec3& p)
{
    double out = 0;
    for (const Viewpoint& eye : eyes) out = std::max(out, pixels_per_metre(eye, p));
    return out;
}

}  // namespace plab::study
