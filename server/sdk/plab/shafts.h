/// Gears and drives: how components couple shafts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "plab/ref.h"

namespace plab
{

/// A velocity factor, turns of driven per turn of driver; exact where it was given as tooth counts.
struct Ratio
{
    double value = 1;
    bool exact = false;  ///< numerator / denominator is the ratio itself
    std::int64_t numerator = 1;
    std::int64_t denominator = 1;
};

/// Phase::Connect of a reduced-coordinate coupling adds its edges here; the host builds the constraint graph from all.
class RatioGraph
{
public:
    virtual ~RatioGraph() = default;
    /// speed(driven) = ratio * speed(driver), held by the component (directory index) for as long as it lives.
    virtual void add(std::uint32_t component, Ref driver, Ref driven, const Ratio& ratio) = 0;
};

/// Shaft motion at one level, seen by Phase::Couple: accelerations and torques inside the solver's stages, speeds and
/// angular impulses at step starts and after impacts. The same code serves both. Shafts that the constraint graph joins
/// move together: their inertia is the component's, reflected.
class ShaftMotion
{
public:
    virtual ~ShaftMotion() = default;
    /// Names the component (directory index) that the following calls belong to, and the shaft that it drives: what it
    /// applies to that one is its reaction. To be called before the first of them.
    virtual void begin(std::uint32_t component, Ref driven) = 0;
    /// rad/s^2 or rad/s.
    virtual double rate(Ref shaft) const = 0;
    /// 1/(kg m^2): change of the rate per unit of torque (impulse); 0 for prescribed motion.
    virtual double mobility(Ref shaft) const = 0;
    /// Adds a torque (N m) or angular impulse (N m s).
    virtual void apply(Ref shaft, double torque) = 0;
    /// Makes the rate what it says, whatever that takes: one-way drives. The shaft then has mobility 0 in this solve.
    virtual void assign(Ref shaft, double rate) = 0;
};

/// Torque that a coupling transmits to its driven shaft; filled by the host for Phase::Finish.
class ShaftReactions
{
public:
    virtual ~ShaftReactions() = default;
    /// N m on driven at the end of the step, by the component that owns the edge; none if it is redundant.
    virtual std::optional<double> torque(std::uint32_t component) const = 0;
};

}  // namespace plab
