#include "implicit_midpoint.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "plab/number_text.h"
#include "reports.h"

namespace plab::solvers
{
namespace
{

constexpr int kFixedPointIterations = 12, kMidpointNewtonIterations = 12, kJacobians = 3, kParts = 64;
constexpr double kGoodContraction = 0.3;
/// Rounding may stop the iteration above the tolerance; up to this factor the result is accepted.
constexpr double kNoise = 100;

class ImplicitMidpointStep
{
public:
    ImplicitMidpointStep(double h, double tolerance, ImplicitMidpointMemory& memory, DynamicSystem& system)
        : h_(h), m_(memory), flat_(system)
    {
        tolerance_ = {tolerance, 1e-3 * tolerance};
        m_.fit(flat_.size());
        flat_.read(m_.y);
        flat_.units(m_.units);
    }

    /// Returns the time reached, s.
    double run()
    {
        double part = h_, t = 0;
        while (t < h_ && !flat_.interrupted())
        {
            const double size = std::min(part, h_ - t);
            if (!solve(t, size))
            {
                part *= 0.5;
                if (part < h_ / kParts) break;
                continue;
            }
            flat_.evaluate(t + 0.5 * size, m_.z, m_.f, size / h_);  // the work of the midpoint
            for (std::size_t i = 0; i < m_.y.size(); ++i) m_.y[i] = 2 * m_.z[i] - m_.y[i];
            t = h_ - t - size < 1e-12 * h_ ? h_ : t + size;
            ++substeps_;
        }
        flat_.write(m_.y);
        return t;
    }
    int iterations() const { return iterations_; }
    int substeps() const { return substeps_; }
    int evaluations() const { return flat_.evaluations(); }

private:
    bool solve(double t, double h)
    {
        flat_.evaluate(t + 0.5 * h, m_.y, m_.f);
        if (!all_finite(m_.f)) return false;
        flat_.sizes(m_.y, m_.f, h, m_.sizes);
        FlatSystem::scales(tolerance_, m_.units, m_.sizes, m_.scale);
        return iterate(t, h, false) || iterate_newton(t, h);
    }

    bool iterate_newton(double t, double h)
    {
        double relative = 1e-7;
        for (int attempt = 0; attempt < kJacobians; ++attempt, relative *= 1e2)
        {
            const bool from_start = attempt != 1;  // the second attempt starts from the result of the first
            if (from_start) m_.z = m_.y;
            flat_.evaluate(t + 0.5 * h, m_.z, m_.f);
            if (!all_finite(m_.f)) continue;
            const JacobianPoint at{t + 0.5 * h,         h,       m_.z,     m_.f,     m_.sizes, m_.units,
                                   tolerance_.absolute, m_.work, m_.slope, m_.other, m_.wide};
            rough_jacobian(flat_, at, relative, m_.jacobian);
            if (factorise(h) && iterate(t, h, true)) return true;
        }
        return false;
    }

    bool factorise(double h)
    {
        const std::size_t n = flat_.size();
        m_.factors.matrix().resize(n);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) m_.factors.matrix()(i, j) = (i == j ? 1.0 : 0.0) - 0.5 * h * m_.jacobian(i, j);
        return m_.factors.factorise([this] { return flat_.interrupted(); });
    }

    /// Iterates from z (Newton) or y (fixed point) until the updates are below the tolerance, or remain at the level of rounding.
    bool iterate(double t, double h, bool newton)
    {
        if (!newton) m_.z = m_.y;
        double before = 0;
        const int limit = newton ? kMidpointNewtonIterations : kFixedPointIterations;
        for (int k = 0; k < limit; ++k)
        {
            if (k > 0) flat_.evaluate(t + 0.5 * h, m_.z, m_.f);
            if (k > 0 || newton) ++iterations_;
            for (std::size_t i = 0; i < m_.y.size(); ++i) m_.update[i] = m_.y[i] + 0.5 * h * m_.f[i] - m_.z[i];
            if (newton) m_.factors.solve(m_.update);
            const double size = FlatSystem::norm(m_.update, m_.scale);
            if (!std::isfinite(size)) return false;
            const double contraction = k > 0 && before > 0 ? size / before : 0;
            if (k > 1 && contraction > (newton ? 0.8 : kGoodContraction)) return size <= kNoise;
            for (std::size_t i = 0; i < m_.y.size(); ++i) m_.z[i] += m_.update[i];
            if (size <= 1 || (k > 1 && contraction < 1 && size * contraction <= 0.1)) return true;
            before = size;
        }
        return false;
    }

    double h_;
    ImplicitMidpointMemory& m_;
    FlatSystem flat_;
    Tolerance tolerance_;
    int iterations_ = 0, substeps_ = 0;
};

}  // namespace

void ImplicitMidpointMemory::fit(std::size_t n)
{
    for (auto* v : {&y, &z, &f, &update, &units, &sizes, &scale, &work, &slope, &other, &wide}) v->resize(n);
}

void ImplicitMidpointRows::describe(Schema& schema)
{
    schema
        .param(relative_tolerance, "relative_tolerance", unit::one,
               "where the iteration for the midpoint ends, relative to speeds and to the path within the step")
        .or_else(1e-12)
        .positive();
    schema.output(iterations, "iterations", unit::one, "iterations for the midpoint in the last step");
    schema.output(substeps, "substeps", unit::one,
                  "parts into which the last step was divided so that the iteration converged; normally 1");
    schema.output(evaluations, "evaluations", unit::one, "force evaluations in the last step");
    schema.scratch(memory, "memory", "working vectors");
}

void advance_implicit_midpoint(const StepContext& context, Row row, ImplicitMidpointRows& rows, DynamicSystem& system)
{
    const StepContext start = context;  // evaluations change the host's context
    ImplicitMidpointStep advance(start.dt, rows.relative_tolerance[row], rows.memory[row], system);
    const double reached = advance.run();
    if (is_trial(start)) return;
    rows.iterations[row] = advance.iterations(), rows.substeps[row] = advance.substeps(), rows.evaluations[row] = advance.evaluations();
    if (reached >= start.dt) return;
    start.emit(row, "solver.failed", Severity::Warning,
               "the iteration for the midpoint did not converge in parts of 1/64 of the step: the group stays where it was at " +
                   rounded_text(reached) + " s of " + rounded_text(start.dt) +
                   " s; possible causes are discontinuous forces or a step that is too long",
               {reached, start.dt});
}

}  // namespace plab::solvers
