/// Gears and drives: how components couple shafts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "plab/ref.h"

namespace plab
{

/// A velocity ratio: turns of the driven shaft per turn of the driver; exact if given as numbers of teeth.
struct Ratio
{
    double value = 1;
    bool exact = false;  ///< numerator / denominator is the exact ratio
    std::int64_t numerator = 1;
    std::int64_t denominator = 1;
};

/// Receives the edges of couplings in reduced coordinates (Phase::Connect); the host builds the constraint graph from all of them.
class RatioGraph
{
public:
    virtual ~RatioGraph() = default;
    /// speed(driven) = ratio * speed(driver), imposed by the component (directory index) as long as it exists.
    virtual void add(std::uint32_t component, Ref driver, Ref driven, const Ratio& ratio) = 0;
};

/// The motion of shafts at one level, for Phase::Couple: accelerations and torques inside the solver's stages, speeds and angular
/// impulses at the start of a step and after impacts. The same code serves both. Shafts joined by the constraint graph move together:
/// their inertia is that of the whole train, reduced to the shaft.
class ShaftMotion
{
public:
    virtual ~ShaftMotion() = default;
    /// Names the component (directory index) to which the following calls belong, and its driven shaft; what it applies to that shaft is
    /// its reaction. To be called before the other functions.
    virtual void begin(std::uint32_t component, Ref driven) = 0;
    /// rad/s^2 or rad/s.
    virtual double rate(Ref shaft) const = 0;
    /// 1/(kg m^2): change of the rate per unit of torque (impulse); 0 for prescribed motion.
    virtual double mobility(Ref shaft) const = 0;
    /// Adds a torque (N m) or angular impulse (N m s).
    virtual void apply(Ref shaft, double torque) = 0;
    /// Sets the rate, whatever torque that takes: for one-way drives. The shaft then has mobility 0 in this solve.
    virtual void assign(Ref shaft, double rate) = 0;
};

/// The torque that a coupling transmits to its driven shaft; filled by the host for Phase::Finish.
class ShaftReactions
{
public:
    virtual ~ShaftReactions() = default;
    /// N m on the driven shaft at the end of the step, by the component that owns the edge; none if the edge is redundant.
    virtual std::optional<double> torque(std::uint32_t component) const = 0;
};

}  // namespace plab
