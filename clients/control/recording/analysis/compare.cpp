#include "control/recording/analysis/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plab::analysis
{
namespace
{

double dot(const plab_v2_Rotation& p, const plab_v2_Rotation& q) { return p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z; }

std::array<ComponentPair, 13> pairs_of(const plab_v2_BodyState& a, const plab_v2_BodyState& b)
{
    const double sign = dot(a.orientation, b.orientation) < 0 ? -1 : 1;
    const plab_v2_Rotation& p = a.orientation;
    const plab_v2_Rotation q{sign * b.orientation.w, sign * b.orientation.x, sign * b.orientation.y, sign * b.orientation.z};
    return {{{"position.x", a.position.x, b.position.x},
             {"position.y", a.position.y, b.position.y},
             {"position.z", a.position.z, b.position.z},
             {"orientation.w", p.w, q.w},
             {"orientation.x", p.x, q.x},
             {"orientation.y", p.y, q.y},
             {"orientation.z", p.z, q.z},
             {"linear_velocity.x", a.linear_velocity.x, b.linear_velocity.x},
             {"linear_velocity.y", a.linear_velocity.y, b.linear_velocity.y},
             {"linear_velocity.z", a.linear_velocity.z, b.linear_velocity.z},
             {"angular_velocity.x", a.angular_velocity.x, b.angular_velocity.x},
             {"angular_velocity.y", a.angular_velocity.y, b.angular_velocity.y},
             {"angular_velocity.z", a.angular_velocity.z, b.angular_velocity.z}}};
}

}  // namespace

double size_of(const ComponentPair& pair)
{
    if (pair.a == pair.b || (std::isnan(pair.a) && std::isnan(pair.b))) return 0;
    const double size = std::fabs(pair.a - pair.b);
    return std::isnan(size) ? std::numeric_limits<double>::infinity() : size;
}

double size_of(std::span<const ComponentPair> pairs)
{
    double out = 0;
    for (const ComponentPair& pair : pairs) out = std::max(out, size_of(pair));
    return out;
}

/// The partner of the same object: by its id, or by its handle if a recording has no names.
std::optional<std::uint32_t> Comparison::Side::handle_of(const std::string& id, std::uint32_t handle) const
{
    const Things& things = log->things();
    return things.has_objects() ? things.handle_of(merged.now().run, id) : handle;
}

bool Comparison::Side::next()
{
    while (const Entry* entry = stream.next())
    {
        const auto* frame = entry->as<plab_v2_Frame>();
        if (frame == nullptr) continue;
        ++frames;
        runs.note(*entry);
        merged.note(*frame);
        when = {*runs.index_of(frame->run), frame->step};
        log_time = seconds(entry->log_time);
        return true;
    }
    return false;
}

Comparison::Comparison(const Log& a, const Log& b) : a_(a), b_(b), a_is_there_(a_.next()), b_is_there_(b_.next()) {}

bool Comparison::next()
{
    if (is_begun_) a_is_there_ = a_is_there_ && a_.next(), b_is_there_ = b_is_there_ && b_.next();
    is_begun_ = true;
    while (a_is_there_ && b_is_there_ && a_.when != b_.when)
        if (a_.when < b_.when)
            a_is_there_ = a_.next();
        else
            b_is_there_ = b_.next();
    if (a_is_there_ && b_is_there_)
    {
        ++compared_;
        frame_ = {a_.when, a_.merged.now().time, a_.log_time};
        return true;
    }
    // The remainder of the longer recording is counted.
    while (a_is_there_) a_is_there_ = a_.next();
    while (b_is_there_) b_is_there_ = b_.next();
    return false;
}

const Comparison::Partner& Comparison::partner_of(std::uint32_t handle)
{
    const auto [known, is_new] = partners_.try_emplace(handle);
    if (!is_new) return known->second;
    known->second.id = a_.log->things().name_of(a_.merged.now().run, handle);
    known->second.handle = b_.handle_of(known->second.id, handle);
    return known->second;
}

void Comparison::note_missing()
{
    const auto note = [](const Side& side, const Side& other, std::set<std::string>& out)
    {
        const auto note_one = [&](std::uint32_t handle)
        {
            const std::string id = side.log->things().name_of(side.merged.now().run, handle);
            const auto there = other.handle_of(id, handle);
            if (!there || (other.merged.find_body(*there) == nullptr && other.merged.find_shaft(*there) == nullptr)) out.insert(id);
        };
        for (const plab_v2_BodyState& body : side.merged.bodies()) note_one(body.handle);
        for (const plab_v2_ShaftState& shaft : side.merged.shafts()) note_one(shaft.handle);
    };
    note(a_, b_, only_a_), note(b_, a_, only_b_);
}

void Comparison::for_each(const std::function<void(const ComparedObject&)>& use)
{
    const std::pair runs{a_.merged.now().run, b_.merged.now().run};
    if (runs != partners_of_) partners_.clear();
    partners_of_ = runs;
    std::size_t found = 0;
    ComparedObject object;
    for (const plab_v2_BodyState& body : a_.merged.bodies())
    {
        const Partner& partner = partner_of(body.handle);
        object.body_a = &body, object.body_b = partner.handle ? b_.merged.find_body(*partner.handle) : nullptr;
        if (object.body_b == nullptr) continue;
        pairs_ = pairs_of(body, *object.body_b);
        object.id = partner.id, object.differences = pairs_;
        ++found, use(object);
    }
    object.body_a = object.body_b = nullptr;
    for (const plab_v2_ShaftState& shaft : a_.merged.shafts())
    {
        const Partner& partner = partner_of(shaft.handle);
        object.shaft_a = &shaft, object.shaft_b = partner.handle ? b_.merged.find_shaft(*partner.handle) : nullptr;
        if (object.shaft_b == nullptr) continue;
        pairs_[0] = {"angle", shaft.angle, object.shaft_b->angle}, pairs_[1] = {"speed", shaft.speed, object.shaft_b->speed};
        object.id = partner.id, object.differences = std::span(pairs_).first(2);
        ++found, use(object);
    }
    const std::size_t in_a = a_.merged.bodies().size() + a_.merged.shafts().size();
    const std::size_t in_b = b_.merged.bodies().size() + b_.merged.shafts().size();
    if (found < in_a || found < in_b) note_missing();
}

}  // namespace plab::analysis
