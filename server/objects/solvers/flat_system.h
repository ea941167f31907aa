#pragma once

#include <span>
#include <vector>

#include "linear/dense.h"
#include "plab/dynamics.h"

namespace plab::solvers
{

using linear::Complex, linear::Factors, linear::SquareMatrix;

/// A DynamicSystem as one flat equation y' = f(t, y), for methods that treat coordinates and speeds alike; and df/dy by differences.
/// The tolerated error of a component: absolute * unit + relative * size.
///
/// `absolute` is in m, rad, m/s, rad/s or the quantity's own unit; angular momenta are divided by the body's largest moment of inertia,
/// so it means rad/s for them, too. The size of a vector is its length. Coordinates start at 0 in each advance, so `relative` refers to
/// the displacement within the advance; summed over a run, to the path.
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
    /// The number of force evaluations so far.
    int evaluations() const { return evaluations_; }
    /// Whether component i of y is a quantity.
    bool is_quantity(std::size_t i) const { return i >= size() - system_->quantity_count(); }
    /// As in DynamicSystem: the step has been interrupted.
    bool interrupted() const { return system_->interrupted(); }
    bool uses_rotations() const { return system_->body_count() > 0; }

    void read(std::span<double> y) const;
    void write(std::span<const double> y);
    /// f(t, y); t in s from the start of the advance, weight as in DynamicSystem.
    void evaluate(double t, std::span<const double> y, std::span<double> f, double weight = 0);

    /// `sizes`: the magnitude of each component of y as used by Tolerance, at y with rates f over h seconds; for coordinates and
    /// quantities at least their change in that time. `units`: the factors of absolute tolerances.
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

/// Where the derivative df/dy is taken, and vectors to work in; all of the system's size.
struct JacobianPoint
{
    double t = 0, h = 0;            ///< s; h is the step
    std::span<const double> y, f;   ///< f = f(t, y)
    std::span<const double> sizes;  ///< of the components of y (FlatSystem::sizes)
    std::span<const double> units;  ///< FlatSystem::units
    double absolute = 0;            ///< quantities smaller than this do not matter
    std::span<double> work, slope, other, wide;
};

/// One-sided differences over `relative` of each component's size: good to about `relative`, which is what Newton's method
/// needs. One evaluation per component. Bodies and shafts have places that the host adds to coordinates, whose rounding a
/// very short increment would drown in: theirs is at least 1e-3 `relative` units. Quantities have none.
void rough_jacobian(FlatSystem& system, const JacobianPoint& at, double relative, SquareMatrix<double>& out);

/// One column, by differences as good as the equations allow. `out` has its size; columns of speeds use those of positions. Where f is
/// linear in a component, a long increment has no truncation error: two lengths that agree prove it, and the derivative is right to
/// rounding (two evaluations). Otherwise central differences with Richardson's extrapolation, over the lengths that agree best (at most 34
/// evaluations).
/// Source of the extrapolation: Press et al., Numerical recipes, section 5.7.
void fine_column(FlatSystem& system, const JacobianPoint& at, std::size_t column, SquareMatrix<double>& out);

}  // namespace plab::solvers
