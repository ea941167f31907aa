#include "angular_velocity/ratio.h"

#include <cmath>
#include <numeric>

namespace plab::constraints
{
namespace
{

__extension__ typedef unsigned __int128 Wide;

constexpr Wide kLargestDenominator = 1'000'000;
constexpr double kLargestInteger = 0x1p53;  // up to here p/q is rounded only once

}  // namespace

// Continued fraction of the double itself, m / 2^k, in integer arithmetic. Its convergents are the best approximations
// (Khinchin, Continued Fractions, theorem 15), so the first one that rounds to the double is the simplest.
Ratio simple_ratio(double factor)
{
    Ratio r;
    r.value = factor;
    const double size = std::fabs(factor);
    if (!(size >= 0.5 / static_cast<double>(kLargestDenominator)) || size >= kLargestInteger) return r;
    int exponent = 0;
    const double mantissa = std::frexp(size, &exponent);
    Wide rest = static_cast<Wide>(static_cast<std::uint64_t>(std::ldexp(mantissa, 53)));
    Wide divisor = static_cast<Wide>(1) << (53 - exponent);
    Wide p = 1, p_before = 0, q = 0, q_before = 1;
    while (divisor != 0)
    {
        const Wide quotient = rest / divisor;
        const Wide remainder = rest % divisor;
        rest = divisor, divisor = remainder;
        if (q != 0 && quotient > kLargestDenominator) break;  // the next q is too large; stopping here also keeps the products in range
        const Wide p_next = quotient * p + p_before;
        const Wide q_next = quotient * q + q_before;
        p_before = p, p = p_next, q_before = q, q = q_next;
        if (q > kLargestDenominator || static_cast<double>(p) > kLargestInteger) break;
        if (static_cast<double>(p) / static_cast<double>(q) != size) continue;
        r.exact = true;
        r.numerator = factor < 0 ? -static_cast<std::int64_t>(p) : static_cast<std::int64_t>(p);
        r.denominator = static_cast<std::int64_t>(q);
        break;
    }
    return r;
}

Ratio tooth_ratio(std::int64_t driver_teeth, std::int64_t driven_teeth, bool reversing)
{
    const std::int64_t common = std::gcd(driver_teeth, driven_teeth);
    Ratio r;
    r.exact = true;
    r.numerator = (reversing ? -driver_teeth : driver_teeth) / common;
    r.denominator = driven_teeth / common;
    r.value = static_cast<double>(r.numerator) / static_cast<double>(r.denominator);
    return r;
}

void describe_factor(Schema& s, Column<double>& velocity_factor, Column<std::int64_t>& driver_teeth, Column<std::int64_t>& driven_teeth,
                     Column<std::string>& mesh)
{
    s.param(velocity_factor, "velocity_factor", unit::one, "turns of driven per turn of driver").or_else(1).nonzero();
    s.param(driver_teeth, "driver_teeth", unit::one, "tooth count of the driver; with driven_teeth, instead of velocity_factor")
        .or_else(0)
        .not_negative()
        .at_most(1e9);
    s.param(driven_teeth, "driven_teeth", unit::one, "tooth count of the driven").or_else(0).not_negative().at_most(1e9);
    s.param(mesh, "mesh", unit::one, "of teeth: external reverses, internal and belt keep the sense of rotation")
        .or_else("external")
        .one_of({"external", "internal", "belt"});
}

Result<Ratio> ratio_of(const FactorGiven& given)
{
    const bool driver = given.driver_teeth != 0;
    const bool driven = given.driven_teeth != 0;
    if (given.driver_teeth < 0) return reason("driver_teeth must be positive, not " + std::to_string(given.driver_teeth));
    if (given.driven_teeth < 0) return reason("driven_teeth must be positive, not " + std::to_string(given.driven_teeth));
    if (driver != driven)
        return reason(std::string("driver_teeth and driven_teeth must be given together and positive; ") +
                      (driver ? "driven_teeth" : "driver_teeth") + " is missing or 0");
    if (driver && given.velocity_factor != 1)
        return reason("the ratio is given twice; give either velocity_factor or driver_teeth and driven_teeth");
    if (driver) return tooth_ratio(given.driver_teeth, given.driven_teeth, given.mesh == "external");
    if (given.mesh != "external")
        return reason("mesh '" + given.mesh + "' needs driver_teeth and driven_teeth; a velocity_factor has its own sign");
    if (given.velocity_factor == 0 || !std::isfinite(given.velocity_factor))
        return reason("velocity_factor must be finite and other than 0");
    return simple_ratio(given.velocity_factor);
}

}  // namespace plab::constraints
