/// Units as authors write them: "km/h", "N m s/rad", "rev/min".
#pragma once

#include <string>
#include <string_view>

#include "plab/result.h"
#include "plab/unit.h"

namespace plab::model
{

/// How a written unit converts a number: value * numerator / denominator * pi^pi_power, in SI and radians. Kept as a fraction
/// so that "7 cm" is the double nearest to 0.07 and "180 deg" is the one nearest to pi.
struct UnitFactor
{
    double numerator = 1;
    double denominator = 1;
    int pi_power = 0;
    Dimension dimension;

    double to_si(double value) const;
};

/// Products by space or "*", quotients by "/" (which divides by the next unit only), powers by "^".
Result<UnitFactor> parse_unit(std::string_view text);

/// Whether a quantity of dimension `written` is acceptable where `declared` is required. Radians must agree, with one
/// exception: a mechanical quantity per radian may be written without it ("N m s" for N m s/rad).
bool unit_fits(const Dimension& written, const Dimension& declared);

/// "m (or cm, mm, km)": the units that an author may use for a declared one.
std::string describe_unit(const Unit& unit);

/// Whether `text` is the symbol of a known unit.
bool is_unit_symbol(std::string_view text);

}  // namespace plab::model
