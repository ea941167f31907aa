/// Quantities of a scene that a study follows over time, and the distance between two time series of one.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "plab/result.h"
#include "world/world.h"

namespace plab::study
{

/// What cannot be stated.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

enum class Measure : std::uint8_t
{
    Mixed,     ///< max over i of |y_i - r_i| / (a + |r_i|), 1
    Geodesic,  ///< angle of the rotation between two attitudes, rad
};

/// "ball.position", "fan.angle", "ball.position.z", "reaction.values.2" (the second of a list), "script.state.count": any field
/// that World::get reads as numbers.
struct Quantity
{
    std::string name;                 ///< as it was written
    std::string id, field;            ///< component and its field
    std::optional<std::size_t> part;  ///< one number of a vector
    std::size_t width = 1;            ///< numbers per sample
    Measure measure = Measure::Mixed;
    std::string unit;                   ///< "m"; of the numbers themselves
    std::vector<std::string> suffixes;  ///< of the numbers' names: ".x"

    /// The name of the i-th number in tables: "ball.position.x"; the quantity's name if it is a single number.
    std::string column(std::size_t i) const;
};

/// Resolves `text` in a world. The error names what exists.
Result<Quantity> resolve_quantity(const world::World& world, const std::string& text);
/// Positions and orientations of all moving bodies and angles of all moving shafts, at most `most`.
std::vector<std::string> default_quantities(const world::World& world, std::size_t most = 4);

/// Appends the current numbers; NaN if the component no longer exists.
void read(const world::World& world, const Quantity& quantity, std::vector<double>& out);

/// Samples of one quantity, one after the other, `width` numbers each.
struct TimeSeries
{
    std::size_t width = 1;
    std::vector<double> values;

    std::size_t samples() const { return values.size() / width; }
    std::span<const double> at(std::size_t i) const { return std::span(values).subspan(i * width, width); }
};

/// The distance between two time series. Reference problems, metric 1: whole series and last sample; NaN if it is not defined.
struct Distance
{
    double series = 0, last = 0;                    ///< by the quantity's measure
    double series_absolute = 0, last_absolute = 0;  ///< largest |y_i - r_i|, in the quantity's unit (attitudes: rad)
};

/// The length a of the mixed error: the largest distance of the reference from its start (largest component, over all samples);
/// its largest magnitude if it does not move, 1 if that is 0 too.
double scale_of(const TimeSeries& reference);

/// Compares the samples that both have; `scale` is a.
Distance distance(const Quantity& quantity, const TimeSeries& series, const TimeSeries& reference, double scale);
/// One sample.
double distance_at(const Quantity& quantity, std::span<const double> y, std::span<const double> r, double scale);
double absolute_distance_at(const Quantity& quantity, std::span<const double> y, std::span<const double> r);

/// 2 atan2(|vec(r* q)|, |w|): the geodesic angle between two attitudes (w, x, y, z), rad.
double attitude_angle(std::span<const double> q, std::span<const double> r);

}  // namespace plab::study
