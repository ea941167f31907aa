/// Reports motion that has diverged although its numbers are still finite, by the event motion.diverged, a warning.
///
/// Three criteria are checked at the end of a step:
///   energy   E(t) - E(t0) - W > kMostGain S + E_f. E: kinetic energy plus the energy that components store (Phase::Potential). W: work of
///            all components except those that store energy, which have none to supply. Responses count even if they store energy,
///            because the ledger divides the simultaneous work of contacts and forces only to first order.
///            S = E(t0) + sum |W_i|, J, where joints, managers and responses count together, if their sum is positive: what one of them
///            takes another gives, and motion that has diverged makes both large. Evaluated only when the kinetic energy has grown
///            fourfold since the last evaluation, so it costs next to nothing; then it must hold for kPatience consecutive steps.
///            Where bodies or shafts are moved from outside (kinematic), W is the work of all components, each counts, and E is kinetic
///            only.
///   growth   the speed of a body or shaft has doubled kMostDoublings times in a row, each time within kQuickSteps steps, which no
///            resolved motion does.
///   contacts the event contact.gains_energy, once per manager or response: the energy that its contacts have created since counting
///            began, although contacts can only dissipate, exceeds kMostCreated (E(t0) + sum |W_i|).
/// A kinetic energy that overflows is reported, too. Energies below E_f = sum 1/2 I (kSmallTurn/h)^2 are ignored: no body turns by a
/// thousandth of a radian, or moves by a thousandth of its radius of gyration, in a step h. Non-finite motion is another event,
/// state.not_finite.
///
/// The states at both ends of the step also serve the detection of bodies that pass through one another (tunnel_watch.h).
///
/// The watch changes nothing and is not part of the hashed state; snapshots keep its memory. Counting of energy restarts after
/// each request.
#pragma once

#include <cstdint>
#include <vector>

#include "simulation/watch/tunnel_watch.h"

namespace plab::simulation
{

/// What the watch remembers from step to step.
struct DivergenceMemory
{
    struct Growth
    {
        double reference = 0;  ///< square of the speed at the last doubling, (m/s)^2 or (rad/s)^2
        std::uint8_t doublings = 0, age = 0;
        /// Whether the speed keeps doubling; `least`: squared speed below which motion is ignored.
        bool runs_away(double speed_squared, double least);
    };
    bool counting = false, reported = false, sealed = false;
    double start_energy = 0, last_kinetic = 0;  ///< J
    double start_other_work = 0;                ///< J, of requests and of removed components
    Tick gaining_since = -1;
    std::int64_t gaining_steps = 0;
    std::vector<double> start_work;          ///< J, by component
    std::vector<double> start_created;       ///< J, by component; infinite once it was reported
    std::vector<std::uint8_t> passive;       ///< by component: stores energy but supplies none
    std::vector<Growth> linear, spin, turn;  ///< by body, body, shaft
    std::vector<std::uint8_t> bodies_reported, shafts_reported;
    TunnelMemory tunnels;
};

class DivergenceWatch
{
public:
    /// To be called after a change from outside: counting of energy restarts with the next step, and the colliding bodies are determined
    /// again.
    void begin_anew() { m_.counting = false, tunnels_.begin_anew(); }
    DivergenceMemory memory() const;
    /// Continues with the memory of another watch.
    void recall(DivergenceMemory memory);
    void before_step(const RunView& s);
    /// Adds warnings to `events`, once per run and object.
    void after_step(const RunView& s, std::vector<Event>& events);

private:
    struct Sources
    {
        double net = 0;    ///< J, W above
        double gross = 0;  ///< J, sum of |W_i|
        double given = 0;  ///< J, the same, holding components together
    };

    bool report_once(Ref object);
    void size_for(const RunView& s);
    void watch_growth(const RunView& s, std::vector<Event>& events);
    void watch_energy(const RunView& s, std::vector<Event>& events);
    void watch_contacts(const RunView& s, std::vector<Event>& events);
    Sources sources(const RunView& s) const;
    double energy(const RunView& s, double kinetic) const;

    TunnelWatch tunnels_;
    DivergenceMemory m_;  ///< without m_.tunnels, which tunnels_ holds
};

}  // namespace plab::simulation
