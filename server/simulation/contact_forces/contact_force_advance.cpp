// Advances an island of groups that may touch by force, in pieces of the step.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "plab/rotation.h"
#include "simulation/contact_forces/contact_forces.h"
#include "simulation/contacts/shape_width.h"

namespace plab::simulation
{
namespace
{
/// Largest number of switching events that are located in one step of one island; later ones take effect at the ends of pieces.
constexpr int kMostEvents = 20000;
/// Smallest number of pieces per contact, however stiff: well inside the stability limit of explicit methods (rate * h < 2 for the
/// weakest).
constexpr double kFewestPerContact = 4;
/// More points are many (steps_among_many).
constexpr std::size_t kFew = 8;
/// The same for a resting contact; and with methods of order 4 and above (rate * h < 2.7 is stable for these), if it is damped: what is not
/// may swing again later, as energy goes to and fro between contacts.
constexpr double kFewestAtRest = 5, kFewestDamped = 2;
/// Twice the ratio to critical damping from which a contact is damped.
constexpr double kDamped = 1;
/// Pieces for the decay of a damper, as a fraction of those for an oscillation: where contacts are damped more than critically, what decays
/// fastest is soon forgotten.
constexpr double kDecayShare = 0.25;
constexpr int kMostTrials = 100;
constexpr int kMostPieces = 10'000'000;
/// As a fraction of the smaller body's radius: gaps up to this are detected, whatever the speeds.
constexpr double kLeastMargin = 1e-8;
/// Longest piece, as a fraction of the time in which a body passes through half of another's thickness: so contacts are detected often
/// enough that no body passes through another unnoticed.
constexpr double kUnseen = 0.25;
/// Half periods in which the estimated speed amplitude of an oscillation is forgotten. In a mixed island it must hardly fall between two
/// turns of an oscillation: pieces that are longer after the largest speed than before it would add energy in every period. The time
/// stepping is symplectic only with pieces of one length.
constexpr double kMemory = 1, kMixedMemory = 16;

double fewest_at_rest(const ContactRates& rates, int order)
{
    const bool damped = rates.damping >= kDamped * std::sqrt(std::max(rates.normal, rates.tangential));
    return damped && order >= 4 ? kFewestDamped : kFewestAtRest;
}

/// m: half of the smallest width. For a hull half of the smallest half-width along its axes, as it may be thinner in other directions.
double thinnest(const Geometry& g)
{
    if (const double known = least_half_width(g); known > 0) return known;
    return 0.5 * std::min({half_width_along(g, {1, 0, 0}), half_width_along(g, {0, 1, 0}), half_width_along(g, {0, 0, 1})});
}
}  // namespace

void ContactForces::save(const GroupSystem& system)
{
    const world::HostTables& host = step_.world.host();
    for (const std::uint32_t b : system.bodies()) memento_.save_body(host, b);
    for (const std::uint32_t s : system.shafts()) memento_.save_shaft(host, s);
    for (const std::uint32_t q : system.quantities()) memento_.save_quantities(host, q);
    before_ = live_;
}

void ContactForces::restore(const GroupSystem& system)
{
    world::HostTables& host = step_.world.host();
    for (const std::uint32_t b : system.bodies()) memento_.restore_body(host, b);
    for (const std::uint32_t s : system.shafts()) memento_.restore_shaft(host, s);
    for (const std::uint32_t q : system.quantities()) memento_.restore_quantities(host, q);
    live_ = before_;
}

bool ContactForces::run(Piece& piece, double to, WorkBook book, bool trial)
{
    piece.system->set_extra_forces(pushing_.empty() ? nullptr : this);
    const bool finite = motion_.run_solver(*piece.system, piece.solver, piece.t, to, book, trial ? nullptr : &step_);
    piece.system->set_extra_forces(nullptr);
    return finite;
}

/// m/s: bound on the closing speed of any two points of the pair.
double ContactForces::closing_bound(const NearPair& p) const
{
    const Bodies& bodies = step_.world.host().bodies;
    const auto turning = [&](Ref r) { return speed_of(r) - length(bodies.velocity[r.index]); };
    return length(bodies.velocity[p.a.index] - bodies.velocity[p.b.index]) + turning(p.a) + turning(p.b);
}

double ContactForces::margin_for(double h) const
{
    double margin = 0;
    for (const NearPair& p : pairs_)
    {
        const double size = std::min(contacts_.radius_of_body()[p.a.index], contacts_.radius_of_body()[p.b.index]);
        if (std::isfinite(size)) margin = std::max(margin, kLeastMargin * size);
        const double travel = 2 * closing_bound(p) * h;
        if (std::isfinite(travel)) margin = std::max(margin, travel);
    }
    // A spring that took over from a hard contact may push before the surfaces touch.
    double open = 0;
    for (const Pushing& p : pushing_) open = std::max(open, -live_.pairs[p.pair].contacts[p.contact].open_depth);
    return margin + 2 * open;
}

/// s: longest piece, at most `most`, in which no body can pass through another one unnoticed.
double ContactForces::free_time(double most) const
{
    double time = most;
    for (const NearPair& p : pairs_)
    {
        const double speed = closing_bound(p), unseen = kUnseen * time_through(p);
        if (!std::isfinite(speed) || !(unseen > 0) || most <= unseen) continue;
        double gap = margin_;
        for (const Seen& s : at_start_)
            if (s.found.contact.a == p.a && s.found.contact.b == p.b) gap = std::min(gap, -s.found.contact.depth);
        time = std::min(time, std::max(gap / speed, unseen));
    }
    return time;
}

/// s: time in which one of the pair passes through half the thickness of the other at their present velocities, along the direction of
/// their relative motion; for rotation through the smallest thickness.
double ContactForces::time_through(const NearPair& p) const
{
    const world::HostTables& host = step_.world.host();
    const Bodies& bodies = host.bodies;
    const Vec3 travel = bodies.velocity[p.b.index] - bodies.velocity[p.a.index];
    const double speed = length(travel), turning = closing_bound(p) - speed;
    double least = std::numeric_limits<double>::infinity();
    for (const Ref r : {p.a, p.b})
        for (const Ref shape : bodies.shapes[r.index])
        {
            const Geometry& g = host.shapes.geometry[shape.index];
            if (g.kind == GeometryKind::Plane) continue;
            double rate = 0;  // 1/s
            if (speed > 0) rate += speed / half_width_along(g, rotate_back(bodies.orientation[r.index] * g.pose.q, travel * (1 / speed)));
            if (turning > 0) rate += turning / thinnest(g);
            if (rate > 0) least = std::min(least, 1 / rate);
        }
    return least;
}

/// Bounds on the largest frequency and decay rate of all pushing contacts together. By Gershgorin's theorem the squared frequencies,
/// the eigenvalues of M^-1 J^T k J, are at most the largest, over the contacts, of the sums over all contacts of its two bodies.
ContactForces::FastestRates ContactForces::fastest_rates()
{
    for (const std::uint32_t b : bodies_.members())
        for (auto& sums : sums_) sums[b] = 0;
    const auto parts = [](const ForceContact& c) { return std::array{c.rates.normal, c.rates.tangential, c.rates.damping}; };
    for (const Pushing& p : pushing_)
    {
        const ForcePair& pair = live_.pairs[p.pair];
        const auto part = parts(pair.contacts[p.contact]);
        const double of_a = pair.contacts[p.contact].rates.share_a;
        for (std::size_t i = 0; i < 3; ++i) sums_[i][pair.a.index] += of_a * part[i], sums_[i][pair.b.index] += (1 - of_a) * part[i];
    }
    std::array<double, 3> most{};
    for (const Pushing& p : pushing_)
    {
        const ForcePair& pair = live_.pairs[p.pair];
        for (std::size_t i = 0; i < 3; ++i) most[i] = std::max(most[i], sums_[i][pair.a.index] + sums_[i][pair.b.index]);
    }
    return {std::sqrt(std::max(most[0], most[1])), most[2]};
}

double ContactForces::spin_rate() const
{
    double rate = 0;
    for (const Pushing& p : pushing_)
        for (const Ref r : {live_.pairs[p.pair].a, live_.pairs[p.pair].b})
            rate = std::max(rate, length(step_.world.host().bodies.angular_velocity[r.index]));
    return rate;
}

/// The error of an oscillation is proportional to its speed amplitude times pieces^-order: as it decays, fewer pieces give the same error.
double ContactForces::pieces_per_contact(const ForceContact& contact, double wanted) const
{
    if (!(contact.swing_speed < contact.peak_swing_speed)) return wanted;
    return std::clamp(wanted * std::pow(contact.swing_speed / contact.peak_swing_speed, 1.0 / order_),
                      std::min(fewest_at_rest(contact.rates, order_), wanted), wanted);
}

/// s: length of a piece while something pushes. The first half of the pieces that a step may have are as short as steps_per_contact asks
/// for, so that a short contact is fully resolved; the other half divide what is left of the step.
double ContactForces::contact_time(double left, int used)
{
    double per_contact = 0, most = kMostPieces, wanted_pieces = 0;
    std::uint32_t response = kNoIndex, detector = kNoIndex;
    for (const Pushing& p : pushing_)
    {
        const ForcePair& pair = live_.pairs[p.pair];
        if (std::exchange(detector, pair.detector) != pair.detector)
        {
            const auto is_it = [&](const Detector& d) { return d.component == pair.detector; };
            const Detector& d = *std::find_if(contacts_.detectors().begin(), contacts_.detectors().end(), is_it);
            response = d.response;
            wanted_pieces = d.steps_per_contact.value_or(200);
            if (pushing_.size() > kFew) wanted_pieces = std::min(wanted_pieces, d.steps_among_many.value_or(40));
            most = std::min(most, d.max_substeps.value_or(20000));
        }
        per_contact = std::max(per_contact, pieces_per_contact(pair.contacts[p.contact], wanted_pieces));
    }
    undersampled_ = false;
    const FastestRates rates = fastest_rates();
    const double rate = rates.decay > 2 * rates.swing ? rates.decay : rates.swing;
    // The rotation of a body within a piece is measured by its rotation vector, which is unique up to half a turn only.
    const double turn = spin_rate();
    const double longest = turn > 0 ? std::min(left, 1 / turn) : left;
    if (!(rate > 0)) return longest;
    const double per_decay = std::min(per_contact, std::max(kDecayShare * per_contact, order_ >= 4 ? kFewestDamped : kFewestAtRest));
    const double wanted = std::numbers::pi / std::max(rates.swing * per_contact, rates.decay * per_decay);
    if (used < 0.5 * most || left / wanted <= most - used) return std::min(longest, wanted);
    if (left / wanted + used > pieces_needed_) pieces_needed_ = left / wanted + used, stiff_ = response;
    undersampled_ = true;
    const double fewest = std::numbers::pi / (rate * kFewestPerContact);
    const double share = left / std::max(most - used, 1.0);
    return std::min(longest, share < fewest ? std::max(share, wanted) : share);
}

double ContactForces::next_time(const Piece& piece)
{
    const double left = piece.end - piece.t;
    const double h = pushing_.empty() ? free_time(left) : contact_time(left, piece.pieces);
    const double n = std::ceil(left / h - 1e-9);
    return n <= 1 ? piece.end : piece.t + left / n;
}

/// The time of the first switch in (t, high], which is known to hold one.
double ContactForces::locate(Piece& piece, double high)
{
    double low = piece.t, width = 2 * (high - low);
    at_low_ = at_start_, at_high_ = at_end_;
    for (int i = 0; i < kMostTrials && !step_.frame.give_up(); ++i)
    {
        double next = guess(low, high, at_low_, at_high_);
        // If the estimates approach from one side only, bisect.
        if (i % 3 == 2 && high - low > 0.25 * width) next = low + 0.5 * (high - low);
        if (i % 3 == 2) width = high - low;
        if (!(next > low && next < high) || high - low <= 0x1p-51 * high) break;
        restore(*piece.system);
        (void)run(piece, next, {}, true);
        ++step_.report.trials;
        inspect(margin_, at_trial_);
        const bool beyond = has_switched(at_trial_);
        if (beyond) at_high_ = at_trial_;
        if (!any_slack_change() && is_there(at_trial_, at_high_)) return next;
        if (!beyond) std::swap(at_low_, at_trial_);
        (beyond ? high : low) = next;
    }
    return high;
}

void ContactForces::one_piece(Piece& piece)
{
    const double before = margin_;
    const double left = piece.end - piece.t;
    const double wanted = margin_for(pushing_.empty() ? left : std::min(left, contact_time(left, piece.pieces)));
    margin_ = before >= wanted && before <= 4 * wanted ? before : 2 * wanted;
    if (margin_ == before && piece.pieces > 0)
        std::swap(at_start_, at_end_);
    else
        inspect(margin_, at_start_);
    double to = next_time(piece);
    save(*piece.system);
    piece.finite = run(piece, to, piece.book, piece.trial);
    inspect(margin_, at_end_);
    const bool switched = has_switched(at_end_);
    if (switched && piece.finite && piece.events < kMostEvents)
    {
        ++piece.events, ++step_.report.events;
        restore(*piece.system);
        if (piece.book.work) (void)run(piece, to, {piece.book.work, -piece.book.sign}, true);
        to = locate(piece, to);
        restore(*piece.system);
        piece.finite = run(piece, to, piece.book, piece.trial);
        inspect(margin_, at_end_);
        evaluate_laws();
    }
    const double from = std::exchange(piece.t, to);
    ++piece.pieces;
    commit(to, to - from);
    switch_contacts(at_end_, to, to - from);
}

void ContactForces::attach(GroupSystem& system, std::span<const std::uint32_t> groups)
{
    bind(groups);
    anchor();
    margin_ = margin_for(0);
    if (!pushing_.empty()) system.set_extra_forces(this);
}

void ContactForces::start(double from)
{
    anchor();
    margin_ = margin_for(1e-9 * step_.frame.step);
    inspect(margin_, at_end_);
    at_start_ = at_end_;
    switch_contacts(at_end_, from, 0);
    if (from > 0) return;
    // The expected largest depth is computed again in each step: a contact that began with a hard impact may have come to rest.
    for (const Seen& s : at_end_)
        if (ForceContact* known = find_pushing(s.found); known && known->asked != step_.frame.tick)
            known->asked = step_.frame.tick, expect(*known, s.found, std::fabs(s.separation_speed));
}

void ContactForces::advance_island(const Island& island, double from, double to, WorkBook book, bool trial)
{
    Piece piece;
    piece.system = &motion_.system_for(island.groups, island.observed);
    piece.solver = solver_of(island);
    piece.begin = piece.t = from, piece.end = to;
    piece.book = book, piece.trial = trial;
    // Kinematic bodies are put to their poses at `from`.
    piece.system->begin(from, from, book, nullptr);
    piece.system->move_prescribed();
    order_ = std::max(1, step_.world.type_of(piece.solver)->info.order);
    memory_ = kMemory;
    start(from);
    // Pieces of free flight and switching events are not limited by max_substeps.
    while (piece.t < to && piece.finite && piece.pieces < kMostPieces && !step_.frame.give_up()) one_piece(piece);
    if (piece.t < to && piece.finite) piece.finite = run(piece, to, book, trial);
    motion_.finish_advance(*piece.system, piece.finite, to, trial);
}

/// Advances an island with persistent hard contacts and springs: by the time stepping of the hard contacts, in pieces as short as the
/// springs need. Springs are evaluated half a piece ahead of the positions, which makes kick and mean move together symplectic:
///   v1 = v0 - h w^2 (x0 + h v0 / 2),  x1 = x0 + h (v0 + v1) / 2   =>   det = 1.
void ContactForces::advance_mixed(const Island& island, double from, double to, WorkBook book, bool trial)
{
    order_ = 2;
    memory_ = kMixedMemory;
    start(from);
    int pieces = 0;
    for (double t = from; t < to && pieces < kMostPieces && !step_.frame.give_up(); ++pieces)
    {
        const double left = to - t;
        const double h = pushing_.empty() ? free_time(left) : contact_time(left, pieces);
        const double n = std::ceil(left / h - 1e-9);
        const double next = n <= 1 ? to : t + left / n;
        margin_ = margin_for(next - t);
        time_ahead_ = 0.5 * (next - t), taken_ = false;
        motion_.feel(this);
        hard_.advance(island.groups, island.observed, t, next, book, trial);
        motion_.feel(nullptr);
        time_ahead_ = 0;
        const double gone = next - std::exchange(t, next);
        std::swap(at_start_, at_end_);
        inspect(margin_, at_end_);
        evaluate_laws();
        commit(t, gone);
        switch_contacts(at_end_, t, gone);
    }
}

}  // namespace plab::simulation
