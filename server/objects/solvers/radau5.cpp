#include "radau5.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "radau5_stages.h"
#include "reports.h"

namespace plab::solvers
{
namespace
{

using namespace radau;

class Radau5Step
{
public:
    Radau5Step(double h, const Tolerance& tolerance, Radau5Memory& memory, DynamicSystem& system)
        : h_(h), m_(memory), flat_(system), stages_(flat_, memory)
    {
        // The estimate is of order 3: see the header.
        const double relative = 0.1 * std::pow(tolerance.relative, 2.0 / 3);
        inner_ = {relative, relative * (tolerance.absolute / tolerance.relative)};
        newton_limit_ = std::max(10 * 2.2e-16 / relative, std::min(0.03, std::sqrt(relative)));
        m_.fit(flat_.size());
        flat_.read(m_.y);
        flat_.units(m_.units);
    }

    Radau5Counts run(std::int64_t limit, const GoesOn& goes_on)
    {
        flat_.evaluate(0, m_.y, m_.f0);
        double size = h_;
        while (t_ < h_ && counts_.accepted + counts_.refused < limit && all_finite(m_.f0) && !flat_.interrupted())
        {
            const double left = h_ - t_;
            const bool last = size >= left * (1 - 1e-12);
            const double step = last ? left : (2 * size > left ? 0.5 * left : size);
            if (t_ + 0.1 * step <= t_) break;
            size = go(step, last);
            counts_.reached = t_;
            if (goes_on && !goes_on(counts_)) break;
        }
        flat_.write(m_.y);
        counts_.evaluations = flat_.evaluations(), counts_.reached = t_;
        return counts_;
    }

private:
    /// Tries one internal step; the length of the next one.
    double go(double step, bool last)
    {
        prepare_scale(step);
        if (!fresh_jacobian_ && !keeps_jacobian_) make_jacobian();
        if (step != factored_)
        {
            ++counts_.factorisations;
            if (!stages_.factorise(step)) return refuse(step, 0.5);
            factored_ = step;
        }
        stages_.predict(step, previous_);
        const NewtonResult newton = stages_.solve(t_, step, newton_limit_);
        if (!newton.converged) return refuse_newton(step, newton);
        const double error = stages_.error(t_, step, counts_.accepted == 0 || refused_before_);
        const double factor = std::min(kSafety, kSafety * (1 + 2 * kNewtonIterations) / (newton.iterations + 2 * kNewtonIterations));
        double quotient = std::clamp(std::pow(std::max(error, 1e-12), 0.25) / factor, 1.0 / kGrow, 1.0 / kShrink);
        // Forces that jump: no step across is short enough for the tolerance, and one that is short is right but for when they jump.
        const bool over_a_jump = step <= kLeast * h_ && std::isfinite(error);
        if (!(error < 1) && !over_a_jump) return refuse(step, std::isfinite(error) ? std::min(0.9, 1 / quotient) : 0.1);
        if (counts_.accepted > 0)
        {
            // Gustafsson's prediction from the last two errors.
            double predicted = (last_size_ / step) * std::pow(error * error / last_error_, 0.25) / kSafety;
            predicted = std::clamp(predicted, 1.0 / kGrow, 1.0 / kShrink);
            quotient = std::max(quotient, predicted);
        }
        if (refused_before_) quotient = std::max(quotient, 1.0);
        last_size_ = step, last_error_ = std::max(1e-2, error);
        accept(step, last, newton);
        // A little more is not worth another factorisation.
        return keeps_jacobian_ && quotient <= 1 && quotient >= 1 / 1.2 ? step : step / quotient;
    }

    void prepare_scale(double step)
    {
        flat_.sizes(m_.y, m_.f0, step, m_.sizes);
        FlatSystem::scales(inner_, m_.units, m_.sizes, m_.scale);
    }

    void make_jacobian()
    {
        const JacobianPoint at{t_, h_, m_.y, m_.f0, m_.sizes, m_.units, inner_.absolute, m_.work, m_.slope, m_.other, m_.wide};
        rough_jacobian(flat_, at, increment_, m_.jacobian);
        fresh_jacobian_ = true, factored_ = 0;
    }

    double refuse(double step, double factor)
    {
        ++counts_.refused;
        refused_before_ = true;
        if (!fresh_jacobian_) keeps_jacobian_ = false;
        // The whole step was too much: from a length over which the rates change little (part I, section II.4).
        if (counts_.accepted == 0 && counts_.refused == 1) return std::min(step * factor, cautious_step(step));
        return step * factor;
    }

    double cautious_step(double step)
    {
        flat_.sizes(m_.y, m_.f0, 0, m_.sizes);
        FlatSystem::scales(inner_, m_.units, m_.sizes, m_.scale);
        const double value = FlatSystem::norm(m_.y, m_.scale), rate = FlatSystem::norm(m_.f0, m_.scale);
        const double guess = 0.01 * std::max(value, 1.0) / rate;
        return guess > 0 && std::isfinite(guess) ? guess : step;
    }

    double refuse_newton(double step, const NewtonResult& newton)
    {
        // With a Jacobian from an earlier point: a new one first. With a fresh one: shorter, and from the third time on with
        // longer increments, as those may have drowned in rounding.
        if (!fresh_jacobian_)
        {
            keeps_jacobian_ = false;
            return refuse(step, 1.0);
        }
        if (++newton_failures_ % 3 == 0 && increment_ < 1e-4) increment_ *= 30, fresh_jacobian_ = keeps_jacobian_ = false;
        return refuse(step, newton.finite ? std::min(0.5, newton.shrink) : 0.1);
    }

    void accept(double step, bool last, const NewtonResult& newton)
    {
        stages_.keep_polynomial();
        previous_ = step;
        book(step);
        for (std::size_t i = 0; i < m_.y.size(); ++i) m_.y[i] += m_.z[2][i];
        t_ = last ? h_ : t_ + step;
        flat_.evaluate(t_, m_.y, m_.f0);
        ++counts_.accepted;
        refused_before_ = false, fresh_jacobian_ = false, newton_failures_ = 0;
        keeps_jacobian_ = newton.contraction < 1e-3;
    }

    void book(double step)
    {
        for (std::size_t s = 0; s < 3; ++s)
        {
            for (std::size_t i = 0; i < m_.y.size(); ++i) m_.work[i] = m_.y[i] + m_.z[s][i];
            flat_.evaluate(t_ + kNode[s] * step, m_.work, m_.other, kWeight[s] * step / h_);
        }
    }

    static constexpr double kSafety = 0.9, kShrink = 1.0 / 5, kGrow = 8;
    static constexpr double kLeast = 1e-10;  ///< of the whole step
    double h_, t_ = 0;
    Tolerance inner_;
    double newton_limit_ = 0;
    Radau5Memory& m_;
    FlatSystem flat_;
    RadauStages stages_;
    Radau5Counts counts_;
    double factored_ = 0, previous_ = 0, last_size_ = 0, last_error_ = 1, increment_ = 1e-7;
    bool fresh_jacobian_ = false, keeps_jacobian_ = false, refused_before_ = false;
    int newton_failures_ = 0;
};

}  // namespace

void Radau5Memory::fit(std::size_t n)
{
    for (auto* v : {&y, &f0, &units, &sizes, &scale, &error, &filtered, &work, &slope, &other, &wide}) v->resize(n);
    for (std::size_t s = 0; s < 3; ++s) z[s].resize(n), w[s].resize(n), f[s].resize(n), polynomial[s].resize(n);
    pair.resize(n);
}

void Radau5Rows::describe(Schema& schema)
{
    describe_control(schema);
    schema.output(factorisations, "factorisations", unit::one, "pairs of linear systems that were factorised in the last step");
    // The name is part of the format of snapshots; with another name, files of earlier versions could not be read.
    schema.state(reported_size, "reported_size", unit::one, "an event has said that the group is large");
    schema.scratch(memory, "memory", "working vectors and matrices");
}

Radau5Counts advance_by_radau(double h, const Tolerance& tolerance, std::int64_t max_substeps, Radau5Memory& memory, DynamicSystem& system,
                              const GoesOn& goes_on)
{
    return Radau5Step(h, tolerance, memory, system).run(max_substeps, goes_on);
}

void report_radau_gave_up(const StepContext& start, Row row, const Radau5Counts& counts)
{
    report_gave_up(start, row, counts, "raise max_substeps or loosen the tolerances");
}

namespace
{

/// Above this many numbers an internal step takes more than about a tenth of a second.
constexpr std::size_t kLarge = 300;

void report_size(const StepContext& start, Row row, Radau5Rows& rows, std::size_t n)
{
    if (n <= kLarge || rows.reported_size[row]) return;
    rows.reported_size[row] = true;
    start.emit(row, "solver.large", Severity::Warning,
               "a group of " + std::to_string(n) +
                   " numbers (places and speeds): each internal step factorises dense matrices of that size, " +
                   "which costs as its cube, and holds " + std::to_string(n * n * 40 >> 20) +
                   " MB; Solver/DormandPrince54 or a shorter step of Solver/RungeKutta4 may be cheaper",
               {static_cast<double>(n)});
}

}  // namespace

void advance_radau5(const StepContext& context, Row row, Radau5Rows& rows, DynamicSystem& system)
{
    const StepContext start = context;  // evaluations change the host's
    const Tolerance tolerance{rows.relative_tolerance[row], rows.absolute_tolerance[row]};
    const Radau5Counts counts = advance_by_radau(start.dt, tolerance, rows.max_substeps[row], rows.memory[row], system);
    if (is_trial(start)) return;
    report_size(start, row, rows, FlatSystem(system).size());
    rows.report(row, counts);
    rows.factorisations[row] = counts.factorisations;
    if (counts.reached < start.dt) report_radau_gave_up(start, row, counts);
}

}  // namespace plab::solvers
