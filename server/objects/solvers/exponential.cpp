#include "exponential.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace plab::solvers
{
namespace
{

constexpr double kNode = 0.75;
constexpr double kCorrection = 32.0 / 9;
constexpr double kRounding = 1e-11;  ///< a bend below it is none
constexpr double kSlight = 1e-8;     ///< a bend below it leaves the step, corrected, as good as exact
constexpr Tolerance kRadauTolerance{1e-9, 1e-12};
constexpr std::int64_t kRadauSubsteps = 100000;

class Advance
{
public:
    Advance(double h, bool trial, ExponentialMemory& memory, DynamicSystem& system) : h_(h), trial_(trial), m_(memory), flat_(system)
    {
        m_.fit(flat_.size());
        flat_.read(m_.y);
        flat_.units(m_.units);
    }

    ExponentialCounts run(bool only_linear)
    {
        ExponentialCounts out;
        out.fine = linearise();
        if (out.fine)
        {
            const double bend = correct();
            out.linear = bend <= kRounding, out.fine = std::isfinite(bend);
            if (out.fine && only_linear) out.fine = bend <= kSlight && bend_along() <= kSlight;
        }
        if (out.fine && !trial_) book();
        if (out.fine) along(0, 1, m_.work);
        out.fine = out.fine && all_finite(m_.work);
        flat_.write(out.fine ? m_.work : m_.y);
        out.evaluations = flat_.evaluations();
        return out;
    }

private:
    bool linearise()
    {
        flat_.evaluate(0, m_.y, m_.f0);
        if (!all_finite(m_.f0)) return false;
        flat_.sizes(m_.y, m_.f0, h_, m_.sizes);
        const JacobianPoint at{0, h_, m_.y, m_.f0, m_.sizes, m_.units, 0, m_.work, m_.slope, m_.other, m_.wide};
        fine_jacobian(flat_, at, m_.jacobian);
        rate_in_time();
        return exponentiate(false);
    }

    /// f_t: forces linear in time show the same slope over the step and over half of it; others by differences of second
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

    /// exp of h J with the columns h f0, h^2 f_t and (with `defect`) 32/9 h D beside it, and a chain of ones below, in time
    /// units of h. Columns are scaled down to the size of h J, so that they cost no accuracy.
    bool exponentiate(bool defect)
    {
        const std::size_t n = flat_.size();
        SquareMatrix<double>& a = m_.exponential.matrix();
        a.resize(n + 3);
        std::fill(a.all().begin(), a.all().end(), 0.0);
        for (std::size_t i = 0; i < n; ++i)
        {
            for (std::size_t j = 0; j < n; ++j) a(i, j) = h_ * m_.jacobian(i, j);
            a(i, n) = h_ * m_.f0[i];
            a(i, n + 1) = h_ * h_ * m_.ft[i];
            a(i, n + 2) = defect ? kCorrection * h_ * m_.defect[i] : 0.0;
        }
        a(n + 1, n) = 1, a(n + 2, n + 1) = 1;
        return m_.exponential.compute();
    }

    /// y after `times` / 2^root of the step.
    void along(int root, int times, std::span<double> out)
    {
        const std::size_t n = flat_.size();
        std::fill(m_.from.begin(), m_.from.end(), 0.0);
        m_.from[n] = 1;
        for (int i = 0; i < times; ++i)
        {
            m_.exponential.apply(root, m_.from, m_.to);
            std::swap(m_.from, m_.to);
        }
        for (std::size_t i = 0; i < n; ++i) out[i] = m_.y[i] + m_.from[i];
    }

    /// defect = f(t, y) - f0 - J (y - y0) - t f_t. How large it is in relation to its largest term, beyond rounding.
    double find_defect(double t, std::span<const double> y)
    {
        flat_.evaluate(t, y, m_.slope);
        const std::size_t n = flat_.size();
        double largest_of_all = 0;
        for (std::size_t i = 0; i < n; ++i)
        {
            double by_jacobian = m_.f0[i] + t * m_.ft[i], largest = std::fabs(by_jacobian);
            for (std::size_t j = 0; j < n; ++j)
            {
                const double part = m_.jacobian(i, j) * (y[j] - m_.y[j]);
                by_jacobian += part;
                largest = std::fmax(largest, std::fabs(part));
            }
            m_.defect[i] = m_.slope[i] - by_jacobian;
            m_.other[i] = largest;
            if (i >= flat_.places()) largest_of_all = std::fmax(largest_of_all, largest / m_.units[i]);
        }
        double bend = 0;
        for (std::size_t i = 0; i < n; ++i)
        {
            const double rounding = 1e-15 * largest_of_all * m_.units[i], beyond = std::fabs(m_.defect[i]) - rounding;
            if (!(beyond <= 0)) bend = std::fmax(bend, beyond / (m_.other[i] + rounding));
        }
        return all_finite(m_.defect) ? bend : std::numeric_limits<double>::infinity();
    }

    double correct()
    {
        along(2, 3, m_.middle);
        const double bend = find_defect(kNode * h_, m_.middle);
        return !std::isfinite(bend) || bend <= kRounding || exponentiate(true) ? bend : std::numeric_limits<double>::infinity();
    }

    double bend_along()
    {
        const int root = std::min(m_.exponential.roots(), 3), points = 1 << root;
        double bend = 0;
        for (int i = 1; i <= points && std::isfinite(bend); ++i)
        {
            along(root, i, m_.middle);
            bend = std::fmax(bend, find_defect(i * h_ / points, m_.middle));
        }
        return bend;
    }

    /// The work of the forces by Boole's rule along the solution, with half a radian between points where that is possible.
    void book()
    {
        int root = MatrixExponential::kLeastRoots;
        while (root < m_.exponential.roots() && std::ldexp(m_.exponential.size(), -root) > 0.5) ++root;
        constexpr double kBoole[4] = {14.0 / 90, 32.0 / 90, 12.0 / 90, 32.0 / 90};
        const int points = 1 << root;
        const std::size_t n = flat_.size();
        std::fill(m_.from.begin(), m_.from.end(), 0.0);
        m_.from[n] = 1;
        for (int i = 0; i <= points; ++i)
        {
            for (std::size_t k = 0; k < n; ++k) m_.work[k] = m_.y[k] + m_.from[k];
            const double weight = i == 0 || i == points ? 0.5 * kBoole[0] : kBoole[i % 4];
            flat_.evaluate(i * h_ / points, m_.work, m_.slope, 4 * weight / points);
            m_.exponential.apply(root, m_.from, m_.to);
            std::swap(m_.from, m_.to);
        }
    }

    double h_;
    bool trial_;
    ExponentialMemory& m_;
    FlatSystem flat_;
};

}  // namespace

void ExponentialMemory::fit(std::size_t n)
{
    for (auto* v : {&y, &f0, &ft, &units, &sizes, &work, &slope, &other, &wide, &middle, &defect}) v->resize(n);
    from.resize(n + 3), to.resize(n + 3);
}

void ExponentialRows::describe(Schema& schema)
{
    schema.param(max_size, "max_size", unit::one, "numbers in a group (places and speeds) above which Radau5 is used")
        .or_else(120)
        .at_least(1);
    schema.output(evaluations, "evaluations", unit::one, "force evaluations in the last step");
    schema.output(linear, "linear", unit::one, "whether the forces were linear, so that the step is exact");
    told.describe(schema);
    schema.scratch(memory, "memory", "working vectors and matrices");
}

ExponentialCounts advance_by_exponential(double h, bool trial, bool only_linear, ExponentialMemory& memory, DynamicSystem& system)
{
    return Advance(h, trial, memory, system).run(only_linear);
}

void advance_exponential(const StepContext& context, Row row, ExponentialRows& rows, DynamicSystem& system)
{
    const StepContext start = context;  // evaluations change the host's
    ExponentialMemory& memory = rows.memory[row];
    const bool small = FlatSystem(system).size() <= static_cast<std::size_t>(rows.max_size[row]);
    if (small)
    {
        const ExponentialCounts counts = advance_by_exponential(start.dt, is_trial(start), false, memory, system);
        if (!is_trial(start)) rows.evaluations[row] = counts.evaluations, rows.linear[row] = counts.linear;
        if (counts.fine) return rows.told.say(start, row, "Exponential");
    }
    rows.told.fall_back(start, row, Fallback::TooLarge, "Radau5",
                        small ? "the exponential of this step overflows" : "the group holds more numbers than max_size");
    const Radau5Counts counts = advance_by_radau(start.dt, is_trial(start), kRadauTolerance, kRadauSubsteps, memory.radau, system);
    if (is_trial(start)) return;
    rows.evaluations[row] = counts.evaluations, rows.linear[row] = false;
    if (counts.reached < start.dt) tell_radau_gave_up(start, row, counts);
}

}  // namespace plab::solvers
