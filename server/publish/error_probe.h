/// What an interaction's error is: by a shadow step against the next finer algorithm of its ladder, or what it says of itself.
#pragma once

#include <map>
#include <string>

#include "publish/pace.h"
#include "simulation/simulation.h"

namespace plab::publish
{

struct ErrorFigure
{
    double value = 0;     ///< not a number where nothing is known
    std::string unit;     ///< of the value
    std::string meaning;  ///< in words: against what, or which residual
};

/// The largest of the outputs that the type declares as errors, with its unit (Simulation::error_of has the value). Without one: not a
/// number, and the meaning says so.
ErrorFigure own_error(const simulation::Simulation& simulation, std::uint32_t component);

/// One step from the present state with the component as it is, and one with `finer` in its place, on copies: how far the
/// participants (or, where it has none of its own, all objects) are apart behind it, per second. Of bodies the largest of
/// |dv| + r |dw| (r: radius of gyration) and |dx| / dt, over dt, in m/s2; of shafts alone of |dw| and |da| / dt, in rad/s2.
/// The simulation itself keeps every bit. An error if the two cannot be exchanged, or the interruption came first.
Result<ErrorFigure> shadow_error(const simulation::Simulation& simulation, std::uint32_t component, const std::string& finer,
                                 const Interruption* interruption = nullptr);

/// Looks at one component after the other, now and then.
class ErrorProbe
{
public:
    /// `share`: of real time that looks may take on average; 0: there are none.
    explicit ErrorProbe(double share) : share_(share) {}

    /// A look, if one is due.
    void follow(const simulation::Simulation& simulation, Nanoseconds now);
    ErrorFigure of(const simulation::Simulation& simulation, std::uint32_t component) const;

private:
    struct Known
    {
        std::string type;
        ErrorFigure figure;
    };
    std::uint32_t next_component(const simulation::Simulation& simulation);

    double share_;
    Nanoseconds due_ = 0, longest_ = 0;
    std::uint64_t run_ = 0, revision_ = 0;
    std::string last_;  ///< id of the component that was looked at last
    std::map<std::string, Known> known_;
};

}  // namespace plab::publish
