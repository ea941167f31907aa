// The motion of the bodies of an island while a manager steps it.
#include <algorithm>
#include <cmath>

#include "plab/pivot.h"
#include "simulation/contacts/held_islands.h"

namespace plab::simulation
{
namespace
{

/// m: what a gap of -depth opens by if its point moves by d. n: from the face to the body; `bend`: Hollow::vector(). In a sphere or
/// cylinder the gap is R less the distance from the centre or axis.
double opened(double depth, const Vec3& d, const Vec3& n, const Vec3& bend)
{
    const double along = dot(d, n), k = length(bend);
    if (k == 0) return along;
    const double axial = is_sphere(bend, n) ? 0 : dot(d, bend) / k, across = length_squared(d) - axial * axial;
    const double a = std::max(0.0, 1 + k * depth), now = a * a - 2 * a * k * along + k * k * across;
    const double sum = a + std::sqrt(std::max(0.0, now));
    return sum > 0 ? (2 * a * along - k * across) / sum : along;
}

}  // namespace

void HeldMotion::begin(GroupSystem& system, Bodies& bodies, Shafts& shafts, std::span<const std::uint32_t> members,
                       std::span<const std::uint32_t> member_of_body, std::span<const std::uint32_t> roots, std::span<Contact> contacts,
                       std::span<ConstraintRow> rows, bool books, Workers& workers)
{
    system_ = &system, bodies_ = &bodies, shafts_ = &shafts;
    members_ = members, member_of_body_ = member_of_body, roots_ = roots, contacts_ = contacts, rows_ = rows, books_ = books;
    workers_ = &workers;
    worked_ = since_start_ = 0;
    rows_are_midway_ = rows.empty();
    shaft_before_.resize(roots.size());
    means_.assign(members.size() + roots.size(), Mean{});
    started_.resize(members.size()), started_turned_.resize(members.size()), arms_.clear();
    for_parts(workers_, members.size(), kKickedPart,
              [&](std::size_t first, std::size_t end)
              {
                  for (std::size_t k = first; k < end; ++k)
                  {
                      const std::uint32_t b = system.bodies()[members[k]];
                      started_[k] = bodies.position[b], started_turned_[k] = bodies.orientation[b];
                  }
              });
}

/// m: from the centre of mass to a point that was at `point` at the start, in the body's frame.
Vec3 HeldMotion::arm(std::uint32_t body, const Vec3& point) const
{
    const std::uint32_t k = member_of_body_[body];
    const bool is_member = k < members_.size() && system_->bodies()[members_[k]] == body;
    if (is_member) return rotate_back(started_turned_[k], point - started_[k]);
    return rotate_back(bodies_->orientation[body], point - bodies_->position[body]);
}

/// Where managers take the velocities of the material points, depths have to be theirs as well.
Pivot::Of HeldMotion::pivot_of(const Contact& c) const { return rows_are_midway_ ? c.pivot.of : Pivot::Of::Neither; }

/// Few methods ask for depths, so arms are found when the first depth is asked for: the start is known then, too.
void HeldMotion::find_arms()
{
    arms_.resize(contacts_.size());
    for_parts(workers_, contacts_.size(), kKickedPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (std::size_t i = begin; i < end; ++i)
                  {
                      const Contact& c = contacts_[i];
                      const Pivot::Of pivot = pivot_of(c);
                      const Vec3 of_a = pivot == Pivot::Of::A ? c.point - c.pivot.arm : c.point;
                      const Vec3 of_b = pivot == Pivot::Of::B ? c.point - c.pivot.arm : c.point;
                      arms_[i] = {arm(c.a.index, of_a), arm(c.b.index, of_b), c.depth};
                  }
              });
}

double HeldMotion::kinetic_energy()
{
    return sum_parts(workers_, members_.size(), kKickedPart, sums_,
                     [&](std::size_t begin, std::size_t end)
                     {
                         double sum = 0;
                         for (std::size_t k = begin; k < end; ++k) sum += bodies_->kinetic_energy(system_->bodies()[members_[k]]);
                         return sum;
                     });
}

double HeldMotion::count_corrections()
{
    const double work_of_corrections = sum_parts(workers_, members_.size(), kKickedPart, sums_,
                                                 [&](std::size_t begin, std::size_t end)
                                                 {
                                                     double sum = 0;
                                                     for (std::size_t k = begin; k < end; ++k) sum -= correction_of(k);
                                                     return sum;
                                                 });
    worked_ -= work_of_corrections;
    return work_of_corrections;
}

/// J: work of the forces along the displacement of a member other than its moves.
double HeldMotion::correction_of(std::size_t k)
{
    const std::uint32_t b = system_->bodies()[members_[k]];
    const Vec3 shift = bodies_->position[b] - started_[k] - means_[k].velocity;
    // A displacement below the rounding error of the position is not a correction.
    if (length(shift) <= 0x1p-48 * (length(started_[k]) + length(means_[k].velocity))) return 0;
    means_[k].velocity += shift;
    return bodies_->mass[b] * dot(system_->acceleration(members_[k]), shift);
}

void HeldMotion::kick(double h)
{
    kicked_.kick(*system_, *bodies_, members_, h, workers_);
    for (std::size_t k = 0; k < roots_.size(); ++k)
    {
        double& speed = shafts_->speed[system_->roots()[roots_[k]]];
        shaft_before_[k] = speed;
        speed += h * system_->speed_rates()[6 * system_->body_count() + roots_[k]];
    }
}

/// Books the displacement of a move before the orientations change: mean velocities of the move times its duration h (s). Calls
/// after(begin, end) for the members that are booked.
template <class After>
void HeldMotion::commit(double h, bool mean, const After& after)
{
    since_start_ += h;
    const auto part = [&](std::size_t begin, std::size_t end, double worked)
    {
        if (books_) worked = commit_part(h, mean, begin, end, worked);
        after(begin, end);
        return worked;
    };
    if (members_.size() <= kKickedPart)
        worked_ = part(0, members_.size(), worked_);
    else
        worked_ += sum_parts(workers_, members_.size(), kKickedPart, sums_,
                             [&](std::size_t begin, std::size_t end) { return part(begin, end, 0); });
    for (std::size_t k = 0; books_ && k < roots_.size(); ++k)
    {
        const double speed = shafts_->speed[system_->roots()[roots_[k]]];
        means_[members_.size() + k].shaft += (mean ? 0.5 * (shaft_before_[k] + speed) : speed) * h;
    }
}

/// J: `worked` and what the forces do on some members.
double HeldMotion::commit_part(double h, bool mean, std::size_t begin, std::size_t end, double worked)
{
    for (std::size_t k = begin; k < end; ++k)
    {
        const KickedBodies::Speeds speeds = kicked_.speeds(k, mean);
        means_[k].velocity += speeds.velocity * h;
        means_[k].momentum += speeds.momentum * h;
        worked += kicked_.power(k, speeds) * h;
    }
    return worked;
}

void HeldMotion::move(double h)
{
    commit(h, false, [&](std::size_t begin, std::size_t end) { kicked_.move_some(begin, end, h); });
    for (const std::uint32_t r : roots_) shafts_->angle[system_->roots()[r]] += shafts_->speed[system_->roots()[r]] * h;
}

void HeldMotion::move_mean(double h)
{
    commit(h, true, [](std::size_t, std::size_t) {});
    (void)kicked_.move_mean(h, rows_are_midway_);
    for (std::size_t k = 0; k < roots_.size(); ++k)
    {
        const std::uint32_t s = system_->roots()[roots_[k]];
        shafts_->angle[s] += 0.5 * h * (shaft_before_[k] + shafts_->speed[s]);
    }
}

/// Calls job(row, same) for each row with the same one of `fresh`, or with null where that is not listed. Both lists have the same order.
template <class Job>
void HeldMotion::for_fresh_rows(std::span<const ConstraintRow> fresh, const Job& job)
{
    std::size_t at = 0;
    const auto same = [](const ConstraintRow& x, const ConstraintRow& y) { return x.component == y.component && x.feature == y.feature; };
    for (ConstraintRow& row : rows_)
    {
        std::size_t found = at;
        while (found < fresh.size() && !same(fresh[found], row)) ++found;
        job(row, found < fresh.size() ? &fresh[found] : nullptr);
        if (found < fresh.size()) at = found + 1;
    }
}

void HeldMotion::refresh_rows()
{
    RowSystem* system = system_->rows();
    if (!system) return;
    system->collect(system_->context());
    for_fresh_rows(system->rows(),
                   [](ConstraintRow& row, const ConstraintRow* fresh)
                   {
                       const double impulse = row.impulse;
                       if (fresh)
                           row = *fresh, row.impulse = impulse;
                       else if (row.kind == RowKind::OneSided)
                           row.error = HUGE_VAL;  // far from acting
                   });
}

bool HeldMotion::put_rows_midway(double h)
{
    RowSystem* system = system_->rows();
    if (!system || joints_close_a_loop()) return false;
    left_.clear();
    const auto go_midway = [&](std::uint32_t b)
    {
        left_.push_back({b, bodies_->position[b], bodies_->orientation[b], bodies_->angular_velocity[b]});
        bodies_->position[b] += bodies_->velocity[b] * (0.5 * h);
        if (bodies_->dynamic(b))
            turn_freely(*bodies_, b, {}, 0.5 * h);
        else
            bodies_->orientation[b] = exp_rotation(bodies_->angular_velocity[b] * (0.5 * h)) * bodies_->orientation[b];
    };
    for (const std::uint32_t k : members_) go_midway(system_->bodies()[k]);
    const auto has_gone = [&](std::uint32_t b)
    {
        return std::any_of(left_.begin() + static_cast<std::ptrdiff_t>(members_.size()), left_.end(),
                           [&](const Left& left) { return left.body == b; });
    };
    for (const ConstraintRow& row : rows_)
        for (const RowBlock& block : std::span(row.blocks).first(row.count))
            if (const Ref r = block.participant;
                r.facet == Facet::Body && bodies_->motion[r.index] == Motion::Kinematic && !has_gone(r.index))
                go_midway(r.index);
    StepContext context = system_->context();
    context.time += 0.5 * h;
    system->collect(context);
    for (const Left& left : left_)
        bodies_->position[left.body] = left.position, bodies_->orientation[left.body] = left.orientation,
        bodies_->angular_velocity[left.body] = left.spin;
    bool turns_far = false;
    for_fresh_rows(system->rows(), [&](const ConstraintRow& row, const ConstraintRow* midway)
                   { turns_far = turns_far || (midway && row.kind != RowKind::ForceChange && row_turns_far(row, *midway)); });
    if (turns_far) return false;
    for_fresh_rows(system->rows(),
                   [](ConstraintRow& row, const ConstraintRow* midway)
                   {
                       if (!midway || row.kind == RowKind::ForceChange) return;
                       row.blocks = midway->blocks, row.rate = midway->rate, row.bias = midway->bias;
                   });
    return rows_are_midway_ = true;
}

/// Whether the levers of a row turn so far until the middle of the step that it says little. A wheel may spin as fast as it will.
bool HeldMotion::row_turns_far(const ConstraintRow& row, const ConstraintRow& midway) const
{
    constexpr double kFar = 0x1p-6;  // rad: beyond it light links of a chain under load gained energy when it was slack
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock &now = row.blocks[k], &then = midway.blocks[k];
        const std::uint32_t b = now.participant.index;
        if (now.participant.facet != Facet::Body || !bodies_->dynamic(b)) continue;
        const Mat3& I = bodies_->inertia_B[b];
        const double gyration = std::sqrt(0.5 * (I(0, 0) + I(1, 1) + I(2, 2)) * bodies_->inverse_mass[b]), linear = length(now.linear);
        if (length(then.linear - now.linear) > kFar * linear) return true;
        if (length(then.angular - now.angular) > kFar * (length(now.angular) + gyration * linear)) return true;
    }
    return false;
}

/// The place of a member among them; of all other bodies and shafts the next one.
std::uint32_t HeldMotion::place_of(Ref participant) const
{
    const auto others = static_cast<std::uint32_t>(members_.size() + roots_.size());
    if (participant.facet == Facet::Body) return bodies_->dynamic(participant.index) ? member_of_body_[participant.index] : others;
    const std::uint32_t k = place_of_root_[participant.index];
    const bool is_root = k < roots_.size() && system_->roots()[roots_[k]] == participant.index;
    return is_root ? static_cast<std::uint32_t>(members_.size()) + k : others;
}

/// Whether a component joins bodies that others have joined already.
bool HeldMotion::joints_close_a_loop()
{
    joined_.reset(members_.size() + roots_.size() + 1);
    place_of_root_.resize(shafts_->size());
    for (std::size_t k = 0; k < roots_.size(); ++k) place_of_root_[system_->roots()[roots_[k]]] = static_cast<std::uint32_t>(k);
    for (std::size_t i = 0, end = 0; i < rows_.size(); i = end)
    {
        while (end < rows_.size() && rows_[end].component == rows_[i].component) ++end;
        const std::span<const ConstraintRow> own = std::span<const ConstraintRow>(rows_).subspan(i, end - i);
        // The rows of a component have the same participants, or fewer; a joint with one participant holds it to the world.
        const ConstraintRow* most = nullptr;
        for (const ConstraintRow& row : own)
            if (row.kind == RowKind::Equality && (!most || row.count > most->count)) most = &row;
        if (!most) continue;
        const std::uint32_t first = place_of(most->blocks[0].participant);
        const auto world = static_cast<std::uint32_t>(members_.size() + roots_.size());
        for (std::uint32_t k = 1; k <= std::max(1u, most->count - 1); ++k)
        {
            const std::uint32_t other = most->count == 1 ? world : place_of(most->blocks[k].participant);
            if (joined_.find(first) == joined_.find(other)) return true;
            joined_.join(first, other);
        }
    }
    return false;
}

Vec3 HeldMotion::moved(std::uint32_t body, const Vec3& arm_B, const Vec3& point) const
{
    if (bodies_->dynamic(body)) return (bodies_->position[body] - point) + rotate(bodies_->orientation[body], arm_B);
    if (bodies_->motion[body] == Motion::Static) return {};
    // The pose of a kinematic body is still that of the start of the step, so its displacement follows from its velocity.
    const Vec3 from_centre = point - bodies_->position[body];
    return bodies_->velocity[body] * since_start_ + (rotate(turned(body), from_centre) - from_centre);
}

/// How a body has turned since the start, in W.
Quat HeldMotion::turned(std::uint32_t body) const
{
    if (bodies_->motion[body] == Motion::Kinematic) return exp_rotation(bodies_->angular_velocity[body] * since_start_);
    const std::uint32_t k = member_of_body_[body];
    const bool is_member = bodies_->dynamic(body) && k < members_.size() && system_->bodies()[members_[k]] == body;
    return is_member ? bodies_->orientation[body] * conjugate(started_turned_[k]) : Quat{};
}

double HeldMotion::separation_speed(std::size_t contact) const
{
    const Contact& c = contacts_[contact];
    const auto speed = [&](std::uint32_t b)
    { return bodies_->velocity[b] + cross(bodies_->angular_velocity[b], rotate(bodies_->orientation[b], arm(b, c.point))); };
    return dot(speed(c.b.index) - speed(c.a.index), c.normal);
}

void HeldMotion::refresh_depths()
{
    if (arms_.empty()) find_arms();
    for (std::size_t i = 0; i < contacts_.size(); ++i)
    {
        Contact& c = contacts_[i];
        if (pivot_of(c) != Pivot::Of::Neither)
        {
            c.depth = depth_on_face(i);
            continue;
        }
        const Vec3 displacement = moved(c.b.index, arms_[i].b, c.point) - moved(c.a.index, arms_[i].a, c.point);
        c.depth = arms_[i].depth - dot(displacement, c.normal);
    }
}

/// m: from where the contact point is now and how the face has turned. The material points of a body that rolls, or is on a face that
/// tilts, would be away from one another by O(h^2).
double HeldMotion::depth_on_face(std::size_t contact) const
{
    const Contact& c = contacts_[contact];
    const bool of_b = c.pivot.of == Pivot::Of::B;
    const std::uint32_t own = of_b ? c.b.index : c.a.index, face = of_b ? c.a.index : c.b.index;
    const Vec3 &arm_own = of_b ? arms_[contact].b : arms_[contact].a, &arm_face = of_b ? arms_[contact].a : arms_[contact].b;
    const bool face_turns = bodies_->motion[face] != Motion::Static;
    const Quat turned_face = face_turns ? turned(face) : Quat{};
    Vec3 displacement = moved(own, arm_own, c.point - c.pivot.arm) - moved(face, arm_face, c.point);
    if (c.pivot.arm != Vec3{}) displacement += turned_arm(c.pivot, of_b ? -c.normal : c.normal, turned(own), turned_face) - c.pivot.arm;
    Vec3 normal = c.normal, bend = c.pivot.hollow.vector();
    if (face_turns) normal = rotate(turned_face, normal), bend = rotate(turned_face, bend);
    return arms_[contact].depth - opened(arms_[contact].depth, displacement, of_b ? normal : -normal, bend);
}

}  // namespace plab::simulation
