/// Tells of motion that has lost its hold while its numbers are still finite: the event motion.diverged, a warning.
///
/// Two signs, both looked for at the end of a step:
///   energy   E(t) - E(t0) - W > kMostGain S + E_f. E: kinetic energy and what components store (Phase::Potential). W: work of
///            all components but those that store energy, which have none to give, contacts aside: the ledger shares what contacts and
///            forces do at one time at first order only. S = E(t0) + sum |W_i|, J. Looked at only when the kinetic energy has grown
///            fourfold since the last look, so that it costs next to nothing; then for kPatience steps, in which it has to hold. Where
///            bodies or shafts are moved from outside (kinematic, prescribed), W is that of all components, and E kinetic.
///   growth   the speed of a body or shaft has doubled kMostDoublings times in a row, each time within kQuickSteps steps: a
///            resolved motion does not do that.
///   contacts contact.gains_energy, once per manager or response: what its contacts have made since counting began, which is no work
///            of theirs (contacts can only take), exceeds kMostMade S.
/// A kinetic energy beyond all numbers counts too. Below E_f = sum 1/2 I (kSmallTurn/h)^2 nothing counts: no body turns by a thousandth, or
/// moves by a thousandth of its radius of gyration, in a step h. Motion that is not finite any more is another event, state.not_finite.
///
/// The same looks at both ends of the step serve the watch for bodies that pass through one another (tunnel_watch.h).
///
/// Not part of the state: neither saved nor hashed, and it changes nothing. Energy is counted anew after each request.
#pragma once

#include <cstdint>
#include <vector>

#include "simulation/watch/tunnel_watch.h"

namespace plab::simulation
{

/// What a watch remembers from step to step.
struct DivergenceMemory
{
    struct Growth
    {
        double reference = 0;  ///< the speed's square when it doubled last, (m/s)^2 or (rad/s)^2
        std::uint8_t doublings = 0, age = 0;
        /// Whether the speed grows without hold; `least`: what counts as moving.
        bool runs_away(double speed_squared, double least);
    };
    bool counting = false, reported = false, sealed = false;
    double start_energy = 0, last_kinetic = 0;  ///< J
    double start_other_work = 0;                ///< J, of requests and of components that are gone
    Tick gaining_since = -1;
    std::int64_t gaining_steps = 0;
    std::vector<double> start_work;          ///< J, by component
    std::vector<double> start_made;          ///< J, by component; infinite once it was told of
    std::vector<std::uint8_t> passive;       ///< by component: gives no energy of its own
    std::vector<Growth> linear, spin, turn;  ///< by body, body, shaft
    std::vector<std::uint8_t> bodies_reported, shafts_reported;
    TunnelMemory tunnels;
};

class DivergenceWatch
{
public:
    /// Something was changed from outside: energy is counted from the next step on, who collides is looked up anew.
    void begin_anew() { m_.counting = false, tunnels_.begin_anew(); }
    DivergenceMemory memory() const;
    /// Goes on as the watch that remembered this did.
    void recall(DivergenceMemory memory);
    void before_step(const RunView& s);
    /// Adds to `events`; once per run and object.
    void after_step(const RunView& s, std::vector<Event>& events);

private:
    struct Sources
    {
        double net = 0, gross = 0;  ///< J
    };

    bool tell(Ref who);
    void size_for(const RunView& s);
    void watch_growth(const RunView& s, std::vector<Event>& events);
    void watch_energy(const RunView& s, std::vector<Event>& events);
    void watch_contacts(const RunView& s, std::vector<Event>& events);
    Sources sources(const RunView& s) const;
    double energy(const RunView& s, double kinetic) const;

    TunnelWatch tunnels_;
    DivergenceMemory m_;  ///< but m_.tunnels: those are in tunnels_
};

}  // namespace plab::simulation
