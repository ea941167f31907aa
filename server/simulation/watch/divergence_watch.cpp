#include "simulation/watch/divergence_watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "simulation/step/totals.h"

namespace plab::simulation
{

namespace
{

constexpr double kMostGain = 100, kMostCreated = 0.05, kGrowthToCheck = 4, kSmallTurn = 1e-3;
constexpr int kMostDoublings = 24, kQuickSteps = 8, kPatience = 8;
constexpr double kEnergyRounding = 0x1p-40;  // rad or m: relative rounding of positions, with a margin for what a step makes of it

double trace(const Mat3& m) { return m(0, 0) + m(1, 1) + m(2, 2); }

/// `moving`: the bodies that are not at rest; null: they are not known.
double kinetic(const world::HostTables& host, const std::vector<std::uint32_t>* moving)
{
    double sum = 0;
    if (moving)
        for (const std::uint32_t b : *moving) sum += host.bodies.kinetic_energy(b);
    else
        for (std::uint32_t b = 0; b < host.bodies.size(); ++b) sum += host.bodies.kinetic_energy(b);
    for (std::uint32_t s = 0; s < host.shafts.size(); ++s) sum += host.shafts.kinetic_energy(s);
    return sum;
}

/// J: energy below which motion is not noticeable in steps of h.
double least_energy(const world::HostTables& host, double h)
{
    const double turn = kSmallTurn / h, rounding = kEnergyRounding / h;
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

/// True if no object is moved from outside: energy can then come only from components.
bool sealed(const world::HostTables& host)
{
    const auto moved = [](Motion m) { return m == Motion::Kinematic; };
    return std::none_of(host.bodies.motion.begin(), host.bodies.motion.end(), moved) &&
           std::none_of(host.shafts.motion.begin(), host.shafts.motion.end(), moved);
}

/// Whether it holds objects: a joint, a coupling, a manager or a response.
bool holds(const world::World& world, std::uint32_t component)
{
    const auto& commands = world.type_of(component)->info.commands;
    return std::any_of(
        commands.begin(), commands.end(),
        [](const CommandInfo& c)
        { return c.phase == Phase::Constrain || c.phase == Phase::Couple || c.phase == Phase::Solve || c.phase == Phase::Respond; });
}

Event warning(const RunView& s, Ref object, const char* what, std::vector<double> values)
{
    Event e;
    e.tick = s.tick, e.time = s.time + s.dt, e.kind = "motion.diverged", e.severity = Severity::Warning;
    e.component = s.world.host().component_of(object), e.a = object;
    e.message = s.world.id_of(object) + " " + what + "; shorter steps, a softer law or another algorithm may prevent it";
    e.values = std::move(values);
    return e;
}

Ref fastest(const world::HostTables& host)
{
    Ref object;
    double most = -1;
    const auto compare = [&](Ref ref, double energy)
    {
        if (energy > most) object = ref, most = energy;
    };
    for (std::uint32_t b = 0; b < host.bodies.size(); ++b) compare({Facet::Body, b}, host.bodies.kinetic_energy(b));
    for (std::uint32_t s = 0; s < host.shafts.size(); ++s) compare({Facet::Shaft, s}, host.shafts.kinetic_energy(s));
    return object;
}

}  // namespace

bool DivergenceMemory::Growth::runs_away(double speed_squared, double least)
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

DivergenceMemory DivergenceWatch::memory() const
{
    DivergenceMemory out = m_;
    out.tunnels = tunnels_.memory();
    return out;
}

void DivergenceWatch::recall(DivergenceMemory memory)
{
    tunnels_.recall(std::move(memory.tunnels));
    m_ = std::move(memory);
    m_.tunnels = {};
}

void DivergenceWatch::size_for(const RunView& s)
{
    const world::HostTables& host = s.world.host();
    if (m_.linear.size() != host.bodies.size()) m_.linear.assign(host.bodies.size(), {}), m_.spin.assign(host.bodies.size(), {});
    if (m_.turn.size() != host.shafts.size()) m_.turn.assign(host.shafts.size(), {});
    m_.bodies_reported.resize(host.bodies.size()), m_.shafts_reported.resize(host.shafts.size());
}

/// Marks the object as reported; true the first time.
bool DivergenceWatch::report_once(Ref object)
{
    std::uint8_t& reported = object.facet == Facet::Body ? m_.bodies_reported[object.index] : m_.shafts_reported[object.index];
    return std::exchange(reported, std::uint8_t{1}) == 0;
}

void DivergenceWatch::before_step(const RunView& s)
{
    tunnels_.before_step(s);
    if (m_.counting) return;
    const Stepper& stepper = s.stepper;
    const world::HostTables& host = s.world.host();
    m_.counting = true, m_.reported = false, m_.sealed = sealed(host), m_.gaining_since = -1, m_.gaining_steps = 0;
    size_for(s);
    m_.start_work = stepper.work();
    m_.start_created.clear();
    for (const ContactEnergy& e : stepper.contact_energy()) m_.start_created.push_back(e.created);
    m_.start_other_work = stepper.departed_work() + stepper.requests_work();
    m_.passive.assign(m_.start_work.size(), 0);
    if (m_.sealed)
    {
        for (const Block& block : stepper.schedule().of(Phase::Potential))
            for (const Row row : block.rows) m_.passive[s.world.tables()[block.table]->component_of_row()[row]] = 1;
        for (const Detector& d : stepper.detectors())
            if (d.response != kNoIndex) m_.passive[d.response] = 0;
    }
    m_.last_kinetic = kinetic(host, nullptr);
    m_.start_energy = energy(s, m_.last_kinetic);
}

double DivergenceWatch::energy(const RunView& s, double kinetic) const
{
    return m_.sealed ? kinetic + stored_energy_of(s.world, s.stepper, s.time, s.tick) : kinetic;
}

DivergenceWatch::Sources DivergenceWatch::sources(const RunView& s) const
{
    const Stepper& stepper = s.stepper;
    const double other = stepper.departed_work() + stepper.requests_work() - m_.start_other_work;
    Sources out{other, std::fabs(other), std::fabs(other)};
    double of_holding = 0;
    for (std::size_t c = 0; c < std::min(m_.start_work.size(), stepper.work().size()); ++c)
    {
        const double work = m_.passive[c] != 0 ? 0 : stepper.work()[c] - m_.start_work[c];
        out.net += work, out.gross += std::fabs(work);
        if (m_.sealed && work != 0 && holds(s.world, static_cast<std::uint32_t>(c)))
            of_holding += work;
        else
            out.given += std::fabs(work);
    }
    out.given += std::max(of_holding, 0.0);
    return out;
}

void DivergenceWatch::after_step(const RunView& s, std::vector<Event>& events)
{
    if (m_.linear.empty() && m_.turn.empty()) return;
    tunnels_.after_step(s, events);
    watch_growth(s, events);
    watch_contacts(s, events);
    if (!m_.reported) watch_energy(s, events);
}

void DivergenceWatch::watch_contacts(const RunView& s, std::vector<Event>& events)
{
    const auto& energy = s.stepper.contact_energy();
    double scale = -1;
    for (const std::uint32_t c : s.world.in_id_order())
    {
        if (c >= std::min(energy.size(), m_.start_created.size()) || !(energy[c].created > m_.start_created[c])) continue;
        // The scale is at least its first term. The others take a pass over all bodies.
        if (energy[c].created - m_.start_created[c] <= kMostCreated * std::fabs(m_.start_energy)) continue;
        if (scale < 0) scale = std::fabs(m_.start_energy) + sources(s).gross + least_energy(s.world.host(), s.dt);
        const double created = energy[c].created - m_.start_created[c];
        if (!(created > kMostCreated * scale)) continue;
        m_.start_created[c] = HUGE_VAL;
        Event e;
        e.tick = s.tick, e.time = s.time + s.dt, e.kind = "contact.gains_energy", e.severity = Severity::Warning, e.component = c;
        char text[160];
        std::snprintf(text, sizeof text,
                      "its contacts have created %.3g J, compared with %.3g J present or added; shorter steps may prevent it", created,
                      scale);
        e.message = text;
        e.values = {created, scale};
        events.push_back(std::move(e));
    }
}

void DivergenceWatch::watch_growth(const RunView& s, std::vector<Event>& events)
{
    const world::HostTables& host = s.world.host();
    const double turn = kSmallTurn / s.dt;
    const auto check = [&](DivergenceMemory::Growth& growth, double speed_squared, double least, Ref object)
    {
        if (growth.runs_away(speed_squared, least) && report_once(object))
            events.push_back(warning(s, object, "keeps doubling its speed every few steps", {std::sqrt(speed_squared)}));
    };
    const auto check_body = [&](std::uint32_t k)
    {
        if (!host.bodies.dynamic(k)) return;
        const double gyration = trace(host.bodies.inertia_B[k]) / 2 * host.bodies.inverse_mass[k];
        const Ref ref{Facet::Body, k};
        check(m_.linear[k], length_squared(host.bodies.velocity[k]), gyration * turn * turn, ref);
        check(m_.spin[k], length_squared(host.bodies.angular_velocity[k]), turn * turn, ref);
    };
    // In the order of ids, which is also the order of events.
    const RestState& rest = s.stepper.contacts().rest();
    if (const std::vector<std::uint32_t>* const moving = rest.moving(); moving && host.shafts.size() == 0)
    {
        for (const std::uint32_t b : *moving) check_body(b);
        return;
    }
    for (const std::uint32_t i : s.world.in_id_order())
    {
        const world::Component& c = s.world.component(i);
        const std::uint32_t k = c.host_index;
        if (c.facet == Facet::Body && !rest.asleep(k)) check_body(k);
        if (c.facet == Facet::Shaft && host.shafts.dynamic(k))
            check(m_.turn[k], host.shafts.speed[k] * host.shafts.speed[k], turn * turn, c.ref(i));
    }
}

void DivergenceWatch::watch_energy(const RunView& s, std::vector<Event>& events)
{
    const world::HostTables& host = s.world.host();
    const double now = kinetic(host, s.stepper.contacts().rest().moving());
    if (now <= kGrowthToCheck * m_.last_kinetic && m_.gaining_steps == 0) return;
    if (!std::isfinite(now))
    {
        m_.reported = true;
        if (const Ref object = fastest(host); report_once(object))
            events.push_back(warning(s, object, "moves so fast that its kinetic energy overflows", {now}));
        return;
    }
    m_.last_kinetic = std::max(now, m_.last_kinetic);
    const Sources from = sources(s);
    const double scale = std::fabs(m_.start_energy) + from.given, gain = energy(s, now) - m_.start_energy - from.net;
    if (!(gain > kMostGain * scale + least_energy(host, s.dt)))
    {
        m_.gaining_steps = 0;
        return;
    }
    if (m_.gaining_steps == 0) m_.gaining_since = s.tick;
    if (++m_.gaining_steps < kPatience) return;
    m_.reported = true;
    char text[160];
    std::snprintf(text, sizeof text,
                  "is the fastest object while energy is created: %.3g J since step %lld, compared with %.3g J present or added", gain,
                  static_cast<long long>(m_.gaining_since), scale);
    if (const Ref object = fastest(host); report_once(object))
        events.push_back(warning(s, object, text, {gain, scale, static_cast<double>(m_.gaining_since)}));
}

}  // namespace plab::simulation
