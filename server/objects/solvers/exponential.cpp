#include "exponential.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace plab::solvers
{
namespace
{

constexpr double kInnerNode = 0.75;
constexpr double kCorrection = 32.0 / 9;
constexpr double kRoundingOfNonlinearity = 1e-11;  ///< a smaller nonlinearity counts as none
constexpr double kSlight = 1e-8;                   ///< with a nonlinearity below this the corrected step is as good as exact
constexpr std::size_t kHuge = 16;
constexpr double kAlike = 10;  ///< times the nonlinearity at the node, in other points
constexpr Tolerance kTolerated{1e-9, 1e-11};
constexpr Tolerance kRadauTolerance{1e-9, 1e-12};
constexpr std::int64_t kRadauSubsteps = 100000;

class ExponentialStep
{
public:
    ExponentialStep(double h, std::size_t most, ExponentialMemory& memory, DynamicSystem& system)
        : h_(h), most_(most), m_(memory), flat_(system)
    {
        m_.fit(flat_.size());
        flat_.read(m_.y);
        flat_.units(m_.units);
    }

    ExponentialCounts run(bool only_linear)
    {
        ExponentialCounts out;
        out.fine = linearise();
        out.too_large = !out.fine && (m_.moving.size() > most_ || is_huge());
        double nonlinearity = 0;
        if (out.fine)
        {
            nonlinearity = correct();
            out.linear = nonlinearity <= kRoundingOfNonlinearity, out.fine = std::isfinite(nonlinearity);
            if (out.fine && only_linear) out.fine = is_as_good_as_linear(nonlinearity);
            out.unsteady = out.fine && !is_steady();
            out.fine = out.fine && !out.unsteady;
        }
        if (out.fine && !(nonlinearity <= kSlight && book_by_moments())) book();
        if (out.fine) along(0, 1, m_.work);
        out.fine = out.fine && all_finite(m_.work);
        flat_.write(out.fine ? m_.work : m_.y);
        out.evaluations = flat_.evaluations();
        return out;
    }

private:
    /// So large that even the derivatives of the numbers that move would take too much memory.
    bool is_huge() const { return flat_.size() > kHuge * most_; }

    bool linearise()
    {
        m_.moving.clear();
        if (is_huge()) return false;
        std::fill(m_.moves.begin(), m_.moves.end(), std::uint8_t{0});
        flat_.evaluate(0, m_.y, m_.f0);
        if (!all_finite(m_.f0)) return false;
        flat_.sizes(m_.y, m_.f0, h_, m_.sizes);
        rate_in_time();
        m_.jacobian.resize(flat_.size());
        std::fill(m_.jacobian.all().begin(), m_.jacobian.all().end(), 0.0);
        for (std::size_t i = 0; i < flat_.size(); ++i)
            if (m_.f0[i] != 0 || m_.ft[i] != 0) set_moving(i);
        return differentiate(0) && exponentiate(false);
    }

    void set_moving(std::size_t i)
    {
        if (m_.moves[i] != 0) return;
        m_.moves[i] = 1;
        m_.moving.push_back(i);
        if (i >= flat_.places() && !flat_.is_quantity(i)) set_moving(i - flat_.places());
    }

    /// Computes the columns of J for the numbers that move, from the one at `next` on, and for those that they set in motion; the other
    /// columns have no effect.
    bool differentiate(std::size_t next)
    {
        const JacobianPoint at{0, h_, m_.y, m_.f0, m_.sizes, m_.units, 0, m_.work, m_.slope, m_.other, m_.wide};
        while (next < m_.moving.size() && m_.moving.size() <= most_)
        {
            const std::size_t fresh = next;
            next = m_.moving.size();
            // Positions first, because the columns of speeds use the stiffness of positions.
            std::sort(m_.moving.begin() + static_cast<std::ptrdiff_t>(fresh), m_.moving.end());
            for (std::size_t k = fresh; k < next; ++k) fine_column(flat_, at, m_.moving[k], m_.jacobian);
            for (std::size_t k = fresh; k < next; ++k)
                for (std::size_t i = 0; i < flat_.size(); ++i)
                    if (m_.jacobian(i, m_.moving[k]) != 0) set_moving(i);
        }
        if (m_.moving.size() > most_) return false;
        std::sort(m_.moving.begin(), m_.moving.end());
        return true;
    }

    /// f_t: forces that are linear in time show the same slope over the whole and over half of the step; others use differences of second
    /// order at the start.
    void rate_in_time()
    {
        flat_.evaluate(h_, m_.y, m_.slope);
        flat_.evaluate(0.5 * h_, m_.y, m_.other);
        bool linear = true;
        for (std::size_t i = 0; i < flat_.size(); ++i)
        {
            m_.ft[i] = (m_.slope[i] - m_.f0[i]) / h_;
            const double half = (m_.other[i] - m_.f0[i]) / (0.5 * h_);
            linear = linear && std::fabs(m_.ft[i] - half) <= 1e-11 * std::fabs(half) + 1e-15 * std::fabs(m_.f0[i]) / h_;
        }
        if (linear) return;
        const double d = h_ / 1024;
        flat_.evaluate(2 * d, m_.y, m_.slope);
        flat_.evaluate(d, m_.y, m_.other);
        for (std::size_t i = 0; i < flat_.size(); ++i) m_.ft[i] = (4 * m_.other[i] - m_.slope[i] - 3 * m_.f0[i]) / (2 * d);
    }

    /// exp of h J with the columns h f0, h^2 f_t and (with `defect`) 32/9 h D appended, and a chain of ones below, in time units of h,
    /// for the numbers that move. The columns are scaled to the size of h J, so they cost no accuracy.
    bool exponentiate(bool defect)
    {
        const std::size_t n = m_.moving.size();
        SquareMatrix<double>& a = m_.exponential.matrix();
        a.resize(n + 3);
        std::fill(a.all().begin(), a.all().end(), 0.0);
        for (std::size_t i = 0; i < n; ++i)
        {
            const std::size_t k = m_.moving[i];
            for (std::size_t j = 0; j < n; ++j) a(i, j) = h_ * m_.jacobian(k, m_.moving[j]);
            a(i, n) = h_ * m_.f0[k];
            a(i, n + 1) = h_ * h_ * m_.ft[k];
            a(i, n + 2) = defect ? kCorrection * h_ * m_.defect[k] : 0.0;
        }
        a(n + 1, n) = 1, a(n + 2, n + 1) = 1;
        m_.from.resize(n + 3), m_.to.resize(n + 3);
        return m_.exponential.compute();
    }

    void start_along()
    {
        std::fill(m_.from.begin(), m_.from.end(), 0.0);
        m_.from[m_.moving.size()] = 1;
    }
    void go_along(int root)
    {
        m_.exponential.apply(root, m_.from, m_.to);
        std::swap(m_.from, m_.to);
    }
    /// out = y0 plus the displacement of the numbers that move, from the vector of the exponential.
    void place(std::span<const double> moved, std::span<double> out)
    {
        std::copy(m_.y.begin(), m_.y.end(), out.begin());
        for (std::size_t i = 0; i < m_.moving.size(); ++i) out[m_.moving[i]] += moved[i];
    }

    /// y after `times` / 2^root of the step.
    void along(int root, int times, std::span<double> out)
    {
        start_along();
        for (int i = 0; i < times; ++i) go_along(root);
        place(m_.from, out);
    }

    /// defect = f(t, y) - f0 - J (y - y0) - t f_t. Returns its size relative to its largest term, beyond rounding.
    double find_defect(double t, std::span<const double> y, double weight = 0)
    {
        flat_.evaluate(t, y, m_.slope, weight);
        const std::size_t n = flat_.size();
        double largest_of_all = 0;
        for (std::size_t i = 0; i < n; ++i)
        {
            double by_jacobian = m_.f0[i] + t * m_.ft[i], largest = std::fabs(by_jacobian);
            for (const std::size_t j : m_.moving)
            {
                const double part = m_.jacobian(i, j) * (y[j] - m_.y[j]);
                by_jacobian += part;
                largest = std::fmax(largest, std::fabs(part));
            }
            m_.defect[i] = m_.slope[i] - by_jacobian;
            m_.other[i] = largest;
            if (i >= flat_.places()) largest_of_all = std::fmax(largest_of_all, largest / m_.units[i]);
        }
        double nonlinearity = 0;
        for (std::size_t i = 0; i < n; ++i)
        {
            const double rounding = 1e-15 * largest_of_all * m_.units[i], beyond = std::fabs(m_.defect[i]) - rounding;
            if (!(beyond <= 0)) nonlinearity = std::fmax(nonlinearity, beyond / (m_.other[i] + rounding));
        }
        return all_finite(m_.defect) ? nonlinearity : std::numeric_limits<double>::infinity();
    }

    double correct()
    {
        along(2, 3, m_.middle);
        const double nonlinearity = find_defect(kInnerNode * h_, m_.middle);
        if (!std::isfinite(nonlinearity) || nonlinearity <= kRoundingOfNonlinearity) return nonlinearity;
        along(0, 1, m_.plain);
        // Nonlinear forces may set numbers in motion that the linear ones left at rest.
        const std::size_t known = m_.moving.size();
        for (std::size_t i = 0; i < flat_.size(); ++i)
            if (m_.defect[i] != 0) set_moving(i);
        std::copy(m_.defect.begin(), m_.defect.end(), m_.middle.begin());
        const bool fine = differentiate(known);
        std::copy(m_.middle.begin(), m_.middle.end(), m_.defect.begin());
        return fine && exponentiate(true) ? nonlinearity : std::numeric_limits<double>::infinity();
    }

    /// Whether the nonlinearity is so small, or has so little effect on the result, that the step is as good as exact; tested at the node
    /// of `correct` and at three more points.
    bool is_as_good_as_linear(double nonlinearity)
    {
        if (nonlinearity > kSlight && !(effect() <= 1)) return false;
        return nonlinearity_along() <= std::max(kSlight, kAlike * nonlinearity);
    }

    /// Whether J has the same effect at the node. The lateral force of an oscillating spring that is not along an axis changes its sign
    /// periodically, but J at the start has only one of the signs, so over many oscillations rounding errors would grow without bound.
    /// Tested with one fixed vector; J may change by as much as makes nothing grow: |h^2 dJ| below 0.1.
    bool is_steady()
    {
        const double turns = m_.exponential.size();
        if (turns <= 1) return true;
        along(2, 3, m_.middle);
        if (has_run_away()) return false;
        flat_.evaluate(kInnerNode * h_, m_.middle, m_.other);
        std::copy(m_.middle.begin(), m_.middle.end(), m_.work.begin());
        for (const std::size_t j : m_.moving) m_.work[j] += probe(j);
        flat_.evaluate(kInnerNode * h_, m_.work, m_.slope);
        const double allowed = std::min(0.05, 0.1 / (turns * turns));
        for (std::size_t i = flat_.places(); i < flat_.size(); ++i)
        {
            double expected = 0, largest = 0;
            for (const std::size_t j : m_.moving)
            {
                const double part = m_.jacobian(i, j) * (m_.work[j] - m_.middle[j]);
                expected += part, largest += std::fabs(part);
            }
            const double rounding = 1e-14 * (std::fabs(m_.other[i]) + largest_rate());
            if (!(std::fabs(m_.slope[i] - m_.other[i] - expected) <= allowed * largest + rounding)) return false;
        }
        return true;
    }
    /// Whether speeds at the node are larger than any force explains: then an instability of J has grown.
    bool has_run_away() const
    {
        double usual = 0, found = 0;
        for (std::size_t i = flat_.places(); i < flat_.size(); ++i)
        {
            usual = std::fmax(usual, (std::fabs(m_.y[i]) + h_ * (std::fabs(m_.f0[i]) + h_ * std::fabs(m_.ft[i]))) / m_.units[i]);
            found = std::fmax(found, std::fabs(m_.middle[i] - m_.y[i]) / m_.units[i]);
        }
        return found > 1e3 * usual;
    }
    double probe(std::size_t j) const
    {
        return (j % 2 == 0 ? 1 : -1) * (0.5 + 0.07 * static_cast<double>(j % 7)) * 1e-3 * std::max(m_.sizes[j], 1e-2 * m_.units[j]);
    }
    /// The largest rate of a speed at the start of the step.
    double largest_rate() const
    {
        double most = 0;
        for (std::size_t i = flat_.places(); i < flat_.size(); ++i) most = std::fmax(most, std::fabs(m_.f0[i]));
        return most;
    }

    /// The correction in units of the tolerance. This is what a method of order 2 would miss; this method has a smaller error.
    double effect()
    {
        along(0, 1, m_.other);
        for (std::size_t i = 0; i < flat_.size(); ++i) m_.other[i] -= m_.plain[i];
        FlatSystem::scales(kTolerated, m_.units, m_.sizes, m_.wide);
        return FlatSystem::norm(m_.other, m_.wide);
    }

    /// The nonlinearity along the step, at points other than the node of `correct`.
    double nonlinearity_along()
    {
        double nonlinearity = 0;
        for (int i = 1; i <= 4 && std::isfinite(nonlinearity); ++i)
        {
            along(2, i, m_.middle);
            if (i != 3) nonlinearity = std::fmax(nonlinearity, find_defect(0.25 * i * h_, m_.middle));
        }
        return nonlinearity;
    }

    /// The work of linear forces, exact for any number of oscillations in the step. Their power is quadratic in the state, so its mean
    /// over the step follows from the mean mu of the state and its covariance L L^T: the sum of P(mu +- l_j) / 2 over the columns of L,
    /// plus (1 - their number) P(mu) (Julier, Uhlmann, Proc. IEEE 92 (2004) 401, exact for quadratic forms). Returns false, with nothing
    /// booked, if forces are not linear as far as those points.
    bool book_by_moments()
    {
        const std::size_t n = m_.moving.size();
        const bool in_time = std::any_of(m_.ft.begin(), m_.ft.end(), [](double f) { return f != 0; });
        const std::size_t rank = m_.exponential.moments(n, in_time ? n + 2 : n, m_.mean, m_.spread);
        const auto point = [&](std::size_t column, double sign)
        {
            for (std::size_t i = 0; i < n + 3; ++i) m_.from[i] = m_.mean[i] + (sign == 0 ? 0.0 : sign * m_.spread[column * (n + 3) + i]);
            place(m_.from, m_.middle);
            return m_.from[n + 1] * h_;  // s
        };
        const auto book_all = [&](double share)
        {
            const double t = point(0, 0);
            double nonlinearity = find_defect(t, m_.middle, share * (1 - static_cast<double>(rank)));
            for (std::size_t j = 0; j < rank; ++j)
                for (const double sign : {1.0, -1.0})
                {
                    const double at = point(j, sign);
                    nonlinearity = std::fmax(nonlinearity, find_defect(at, m_.middle, 0.5 * share));
                }
            return nonlinearity;
        };
        if (book_all(1) <= kSlight) return true;
        book_all(-1);
        return false;
    }

    /// The work of other forces by Boole's rule along the solution, with at most half a radian between points where possible.
    void book()
    {
        int root = MatrixExponential::kLeastRoots;
        while (root < m_.exponential.roots() && std::ldexp(m_.exponential.size(), -root) > 0.5) ++root;
        constexpr double kBoole[4] = {14.0 / 90, 32.0 / 90, 12.0 / 90, 32.0 / 90};
        const int points = 1 << root;
        start_along();
        for (int i = 0; i <= points; ++i)
        {
            place(m_.from, m_.work);
            const double weight = i == 0 || i == points ? 0.5 * kBoole[0] : kBoole[i % 4];
            flat_.evaluate(i * h_ / points, m_.work, m_.slope, 4 * weight / points);
            go_along(root);
        }
    }

    double h_;
    std::size_t most_;
    ExponentialMemory& m_;
    FlatSystem flat_;
};

}  // namespace

void ExponentialMemory::fit(std::size_t n)
{
    for (auto* v : {&y, &f0, &ft, &units, &sizes, &work, &slope, &other, &wide, &middle, &defect, &plain}) v->resize(n);
    moves.resize(n);
}

void ExponentialRows::describe(Schema& schema)
{
    schema.param(max_size, "max_size", unit::one, "largest number of positions and speeds that move in a group; above it Radau5 is used")
        .or_else(120)
        .at_least(1)
        .at_most(2000);
    schema.output(evaluations, "evaluations", unit::one, "force evaluations in the last step");
    schema.output(linear, "linear", unit::one, "whether the forces were linear, so that the step is exact");
    resolved.describe(schema);
    schema.scratch(memory, "memory", "working vectors and matrices");
}

ExponentialCounts advance_by_exponential(double h, bool only_linear, std::size_t most, ExponentialMemory& memory, DynamicSystem& system)
{
    return ExponentialStep(h, most, memory, system).run(only_linear);
}

void advance_exponential(const StepContext& context, Row row, ExponentialRows& rows, DynamicSystem& system)
{
    const StepContext start = context;  // evaluations change the host's context
    ExponentialMemory& memory = rows.memory[row];
    const auto most = static_cast<std::size_t>(rows.max_size[row]);
    const ExponentialCounts counts = advance_by_exponential(start.dt, false, most, memory, system);
    if (!is_trial(start)) rows.evaluations[row] = counts.evaluations, rows.linear[row] = counts.linear;
    if (counts.fine) return rows.resolved.say(start, row, "Exponential");
    rows.resolved.fall_back(start, row, Fallback::TooLarge, "Radau5",
                            counts.too_large
                                ? "the group has " + std::to_string(FlatSystem(system).size()) +
                                      " numbers (positions and speeds), of which more than max_size = " + std::to_string(most) + " move"
                            : counts.unsteady ? "the lateral effect of stiff forces changes within the step"
                                           : "the exponential of this step overflows");
    const Radau5Counts done = advance_by_radau(start.dt, kRadauTolerance, kRadauSubsteps, memory.radau, system);
    if (is_trial(start)) return;
    rows.evaluations[row] = done.evaluations, rows.linear[row] = false;
    if (done.reached < start.dt) report_radau_gave_up(start, row, done);
}

}  // namespace plab::solvers
