#include "simulation/watch/divergence_watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "simulation/simulation.h"

namespace plab::simulation
{

namespace
{

constexpr double kMostGain = 100, kLook = 4, kSmallTurn = 1e-3;
constexpr int kMostDoublings = 24, kQuickSteps = 8, kPatience = 8;
constexpr double kRounding = 0x1p-40;  // of places, with room for what a step makes of it

double trace(const Mat3& m) { return m(0, 0) + m(1, 1) + m(2, 2); }

double kinetic(const world::HostTables& host)
{
    double sum = 0;
    for (std::uint32_t b = 0; b < host.bodies.size(); ++b) sum += host.bodies.kinetic_energy(b);
    for (std::uint32_t s = 0; s < host.shafts.size(); ++s) sum += host.shafts.kinetic_energy(s);
    return sum;
}

/// J: what does not count, in steps of h.
double least_energy(const world::HostTables& host, double h)
{
    const double turn = kSmallTurn / h, rounding = kRounding / h;
    double sum = 0;
    for (std::uint32_t b = 0; b < host.bodies.size(); ++b)
    {
        if (!host.bodies.dynamic(b)) continue;
        sum += trace(host.bodies.inertia_B[b]) * turn * turn;
        sum += host.bodies.mass[b] * length_squared(host.bodies.position[b]) * rounding * rounding;
    }
    for (std::uint32_t s = 0; s < host.shafts.size(); ++s)
        if (host.shafts.dynamic(s)) sum += host.shafts.inertia[s] * (turn * turn + std::pow(host.shafts.angle[s] * rounding, 2));
    return sum;
}

/// Nobody moves but by forces.
bool sealed(const world::HostTables& host)
{
    const auto moved = [](Motion m) { return m == Motion::Kinematic; };
    return std::none_of(host.bodies.motion.begin(), host.bodies.motion.end(), moved) &&
           std::none_of(host.shafts.motion.begin(), host.shafts.motion.end(), moved);
}

Event warning(const Simulation& s, Ref who, const char* what, std::vector<double> values)
{
    Event e;
    e.tick = s.tick(), e.time = s.time() + s.dt(), e.kind = "motion.diverged", e.severity = Severity::Warning;
    e.component = s.world().host().component_of(who), e.a = who;
    e.message = s.world().id_of(who) + " " + what + "; shorter steps, a softer law or another algorithm may hold it";
    e.values = std::move(values);
    return e;
}

Ref fastest(const world::HostTables& host)
{
    Ref who;
    double most = -1;
    const auto ask = [&](Ref ref, double energy)
    {
        if (energy > most) who = ref, most = energy;
    };
    for (std::uint32_t b = 0; b < host.bodies.size(); ++b) ask({Facet::Body, b}, host.bodies.kinetic_energy(b));
    for (std::uint32_t s = 0; s < host.shafts.size(); ++s) ask({Facet::Shaft, s}, host.shafts.kinetic_energy(s));
    return who;
}

}  // namespace

bool DivergenceWatch::Growth::runs_away(double speed_squared, double least)
{
    ++age;
    if (speed_squared > 4 * reference)
    {
        doublings = speed_squared > least ? static_cast<std::uint8_t>(std::min(doublings + 1, kMostDoublings)) : std::uint8_t{0};
        reference = speed_squared, age = 0;
    }
    else if (age >= kQuickSteps)
        reference = speed_squared, age = doublings = 0;
    return doublings >= kMostDoublings;
}

void DivergenceWatch::size_for(const Simulation& s)
{
    const world::HostTables& host = s.world().host();
    if (way_.size() != host.bodies.size()) way_.assign(host.bodies.size(), {}), spin_.assign(host.bodies.size(), {});
    if (turn_.size() != host.shafts.size()) turn_.assign(host.shafts.size(), {});
    bodies_told_.resize(host.bodies.size()), shafts_told_.resize(host.shafts.size());
}

/// Whether this is the first word about `who`.
bool DivergenceWatch::tell(Ref who)
{
    std::uint8_t& told = who.facet == Facet::Body ? bodies_told_[who.index] : shafts_told_[who.index];
    return std::exchange(told, std::uint8_t{1}) == 0;
}

void DivergenceWatch::before_step(const Simulation& s)
{
    tunnels_.before_step(s);
    if (counting_) return;
    const Stepper& stepper = s.stepper();
    const world::HostTables& host = s.world().host();
    counting_ = true, told_ = false, sealed_ = sealed(host), gaining_since_ = -1, gaining_steps_ = 0;
    size_for(s);
    start_work_ = stepper.work();
    start_other_work_ = stepper.departed_work() + stepper.requests_work();
    passive_.assign(start_work_.size(), 0);
    if (sealed_)
    {
        for (const Block& block : stepper.schedule().of(Phase::Potential))
            for (const Row row : block.rows) passive_[s.world().tables()[block.table]->component_of_row()[row]] = 1;
        for (const Detector& d : stepper.detectors())
            if (d.response != kNoIndex) passive_[d.response] = 0;
    }
    last_kinetic_ = kinetic(host);
    start_energy_ = energy(s, last_kinetic_);
}

double DivergenceWatch::energy(const Simulation& s, double kinetic) const { return sealed_ ? kinetic + s.stored_energy() : kinetic; }

DivergenceWatch::Sources DivergenceWatch::sources(const Simulation& s) const
{
    const Stepper& stepper = s.stepper();
    const double other = stepper.departed_work() + stepper.requests_work() - start_other_work_;
    Sources out{other, std::fabs(other)};
    for (std::size_t c = 0; c < std::min(start_work_.size(), stepper.work().size()); ++c)
    {
        const double work = passive_[c] != 0 ? 0 : stepper.work()[c] - start_work_[c];
        out.net += work, out.gross += std::fabs(work);
    }
    return out;
}

void DivergenceWatch::after_step(const Simulation& s, std::vector<Event>& events)
{
    if (way_.empty() && turn_.empty()) return;
    tunnels_.after_step(s, events);
    look_at_growth(s, events);
    if (!told_) look_at_energy(s, events);
}

void DivergenceWatch::look_at_growth(const Simulation& s, std::vector<Event>& events)
{
    const world::HostTables& host = s.world().host();
    const double turn = kSmallTurn / s.dt();
    const auto look = [&](Growth& growth, double speed_squared, double least, Ref who)
    {
        if (growth.runs_away(speed_squared, least) && tell(who))
            events.push_back(warning(s, who, "doubles its speed every few steps, on and on", {std::sqrt(speed_squared)}));
    };
    for (std::uint32_t b = 0; b < host.bodies.size(); ++b)
    {
        if (!host.bodies.dynamic(b)) continue;
        const double gyration = trace(host.bodies.inertia_B[b]) / 2 * host.bodies.inverse_mass[b];
        look(way_[b], length_squared(host.bodies.velocity[b]), gyration * turn * turn, {Facet::Body, b});
        look(spin_[b], length_squared(host.bodies.angular_velocity[b]), turn * turn, {Facet::Body, b});
    }
    for (std::uint32_t k = 0; k < host.shafts.size(); ++k)
        if (host.shafts.dynamic(k)) look(turn_[k], host.shafts.speed[k] * host.shafts.speed[k], turn * turn, {Facet::Shaft, k});
}

void DivergenceWatch::look_at_energy(const Simulation& s, std::vector<Event>& events)
{
    const world::HostTables& host = s.world().host();
    const double now = kinetic(host);
    if (now <= kLook * last_kinetic_ && gaining_steps_ == 0) return;
    if (!std::isfinite(now))
    {
        told_ = true;
        if (const Ref who = fastest(host); tell(who))
            events.push_back(warning(s, who, "moves faster than energies can be computed with", {now}));
        return;
    }
    last_kinetic_ = std::max(now, last_kinetic_);
    const Sources given = sources(s);
    const double scale = std::fabs(start_energy_) + given.gross, gain = energy(s, now) - start_energy_ - given.net;
    if (!(gain > kMostGain * scale + least_energy(host, s.dt())))
    {
        gaining_steps_ = 0;
        return;
    }
    if (gaining_steps_ == 0) gaining_since_ = s.tick();
    if (++gaining_steps_ < kPatience) return;
    told_ = true;
    char text[160];
    std::snprintf(text, sizeof text,
                  "is the fastest where energy comes from nowhere: %.3g J since step %lld, while %.3g J were there or put in", gain,
                  static_cast<long long>(gaining_since_), scale);
    if (const Ref who = fastest(host); tell(who))
        events.push_back(warning(s, who, text, {gain, scale, static_cast<double>(gaining_since_)}));
}

}  // namespace plab::simulation
