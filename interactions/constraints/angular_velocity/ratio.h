/// Velocity factors as exact rationals.
#pragma once

#include <cstdint>
#include <string>

#include "plab/registrar.h"
#include "plab/result.h"
#include "plab/shafts.h"

namespace plab::constraints
{

/// The simplest p/q with q <= 10^6 that equals `factor` as a double, if there is one: 0.1 is 1/10.
Ratio simple_ratio(double factor);

/// Turns of driven per turn of driver: +- driver_teeth / driven_teeth, minus for an external mesh.
Ratio tooth_ratio(std::int64_t driver_teeth, std::int64_t driven_teeth, bool reversing);

/// The factor as written in a scene. Tooth counts of 0 mean "not given".
struct FactorGiven
{
    double velocity_factor = 1;
    std::int64_t driver_teeth = 0;
    std::int64_t driven_teeth = 0;
    std::string mesh = "external";
};
/// Declares the parameters that give a factor.
void describe_factor(Schema& s, Column<double>& velocity_factor, Column<std::int64_t>& driver_teeth, Column<std::int64_t>& driven_teeth,
                     Column<std::string>& mesh);
/// The ratio, or an error if the input is ambiguous or incomplete.
Result<Ratio> ratio_of(const FactorGiven& given);

}  // namespace plab::constraints
