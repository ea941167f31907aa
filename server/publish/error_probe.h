/// Measures the error of an interaction: by a shadow step against the next finer algorithm of its ladder, or by the error
/// output that its type declares.
#pragma once

#include <map>
#include <string>

#include "publish/pace.h"
#include "simulation/simulation.h"

namespace plab::publish
{

struct ErrorFigure
{
    double value = 0;     ///< NaN if nothing is known
    std::string unit;     ///< of the value
    std::string meaning;  ///< in words: what it is compared with, or which residual it is
};

/// The largest of the outputs that the type declares as errors, with its unit (Simulation::error_of returns the value). Without
/// such an output: NaN, and the meaning says so.
ErrorFigure own_error(const simulation::Simulation& simulation, std::uint32_t component);

/// Makes one step from the current state with the component unchanged, and one with `finer` in its place, on copies. The error
/// is the difference of the participants (or of all objects, if it has no participants) after the step, per second: for bodies
/// the largest of |dv| + r |dw| (r: radius of gyration) and |dx| / dt, over dt, in m/s2; if there are only shafts, of |dw| and
/// |da| / dt, in rad/s2. The simulation itself stays bit-identical. An error if the two types cannot be exchanged, or if the
/// interruption came first.
Result<ErrorFigure> shadow_error(const simulation::Simulation& simulation, std::uint32_t component, const std::string& finer,
                                 const Interruption* interruption = nullptr);

/// Measures one component after the other, from time to time.
class ErrorProbe
{
public:
    /// `share`: average share of real time that measurements may take; 0: no measurements.
    explicit ErrorProbe(double share) : share_(share) {}

    /// Makes one measurement, if one is due.
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
    std::string last_;  ///< id of the component that was measured last
    std::map<std::string, Known> known_;
};

}  // namespace plab::publish
