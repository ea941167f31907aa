/// A DynamicSystem as one flat equation y' = f(t, y), for methods that treat coordinates and speeds alike.
#pragma once

#include <span>
#include <vector>

#include "plab/dynamics.h"

namespace plab::solvers
{

/// What an error may be: per component absolute * unit + relative * size.
///
/// `absolute` is in m, rad, m/s, rad/s or the quantity's own unit; angular momenta are weighed by the body's largest
/// moment of inertia, so it means rad/s for them too. Sizes of vectors are their lengths. Coordinates start at 0 in each
/// advance, so `relative` counts what a body moved within the advance: summed over a run, its path.
struct Tolerance
{
    double relative = 0;
    double absolute = 0;
};

/// y = (coordinates that have rates, speeds). Quantities have no coordinates.
class FlatSystem
{
public:
    explicit FlatSystem(DynamicSystem& system)
        : system_(&system), places_(system.coordinates().size() - system.quantity_count()), speeds_(system.speeds().size())
    {
    }
    std::size_t size() const { return places_ + speeds_; }
    std::size_t places() const { return places_; }
    /// Evaluations of forces so far.
    int evaluations() const { return evaluations_; }
    /// Whether component i of y is a quantity.
    bool is_quantity(std::size_t i) const { return i >= size() - system_->quantity_count(); }
    /// As DynamicSystem: the step is given up.
    bool interrupted() const { return system_->interrupted(); }
    bool uses_rotations() const { return system_->body_count() > 0; }

    void read(std::span<double> y) const;
    void write(std::span<const double> y);
    /// f(t, y); t in s from the start of the advance, weight as in DynamicSystem.
    void evaluate(double t, std::span<const double> y, std::span<double> f, double weight = 0);

    /// `sizes`: how large each component of y is, in the sense of Tolerance, at y with rates f and over h seconds: at least
    /// what it changes in that time, for coordinates and quantities. `units`: what absolute tolerances are multiplied by.
    void sizes(std::span<const double> y, std::span<const double> f, double h, std::span<double> sizes) const;
    void units(std::span<double> units) const;
    /// max |e_i| / (absolute * unit_i + relative * size_i).
    static double norm(std::span<const double> e, std::span<const double> scale);
    static void scales(const Tolerance& tolerance, std::span<const double> units, std::span<const double> sizes, std::span<double> out);

private:
    DynamicSystem* system_;
    std::size_t places_, speeds_;
    int evaluations_ = 0;
};

bool all_finite(std::span<const double> y);

}  // namespace plab::solvers
