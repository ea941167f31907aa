#include "dormand_prince54.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "plab/minimal_coordinates.h"

namespace plab::solvers
{

namespace
{

constexpr std::size_t kDormandPrinceStages = 7;
constexpr double kDormandPrinceNode[kDormandPrinceStages] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
constexpr double kTable[kDormandPrinceStages][kDormandPrinceStages - 1] = {
    {},
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
};
constexpr const double* kDormandPrinceWeight = kTable[kDormandPrinceStages - 1];
constexpr double kError[kDormandPrinceStages] = {71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
constexpr double kSafety = 0.9, kShrink = 0.2, kGrow = 10, kIntegral = 0.04;  // part II, eq. (2.43): beta = 0.04

double weight_of(std::size_t stage) { return stage < kDormandPrinceStages - 1 ? kDormandPrinceWeight[stage] : 0.0; }

class DormandPrinceStep
{
public:
    DormandPrinceStep(double h, const Tolerance& tolerance, DormandPrinceMemory& memory, DynamicSystem& system, double from)
        : h_(h), t_(from), tolerance_(tolerance), m_(memory), flat_(system)
    {
        m_.fit(flat_.size());
        flat_.read(m_.y);
        flat_.units(m_.units);
    }

    DormandPrinceCounts run(std::int64_t limit)
    {
        double size = first_size(), last_error = 1e-4;
        bool refused_before = false;
        while (t_ < h_ && counts_.accepted + counts_.refused < limit && !flat_.interrupted())
        {
            const double left = h_ - t_;
            const bool last = size >= left * (1 - 1e-12);
            // Two equal steps rather than a long one and a tiny one.
            const double step = last ? left : (2 * size > left ? 0.5 * left : size);
            first_stage(step);
            const double error = attempt(step);
            if (!(error <= 1))
            {
                take_back(step);
                refused_before = true;
                ++counts_.refused;
                const double factor = std::isfinite(error) ? std::max(0.02, kSafety * std::pow(error, -0.2)) : 0.1;
                size = step * factor;
                if (t_ + 0.01 * size <= t_) break;
                continue;
            }
            const double expo = 0.2 - 0.75 * kIntegral;
            const double bounded = std::max(error, 1e-10);
            double factor = kSafety * std::pow(bounded, -expo) * std::pow(last_error, kIntegral);
            factor = std::clamp(factor, kShrink, refused_before ? 1.0 : kGrow);
            last_error = std::max(error, 1e-4), refused_before = false;
            accept(step, last);
            size = step * factor;
        }
        flat_.write(m_.y);
        counts_.evaluations = flat_.evaluations(), counts_.reached = t_;
        return counts_;
    }

private:
    /// The length of the first trial: the whole step, unless the equations appear to be too fast for it. Hairer's estimate (part I,
    /// section II.4) from the rates and their change along an Euler step.
    double first_size()
    {
        const double left = h_ - t_;
        flat_.evaluate(t_, m_.y, m_.slope[0], booked_ = kDormandPrinceWeight[0] * (left / h_));
        flat_.sizes(m_.y, m_.slope[0], left, m_.sizes);
        FlatSystem::scales(tolerance_, m_.units, m_.sizes, m_.scale);
        const double value = FlatSystem::norm(m_.y, m_.scale), rate = FlatSystem::norm(m_.slope[0], m_.scale);
        if (!(rate > 0) || !std::isfinite(rate)) return left;
        const double probe = std::min(left, 0.01 * std::max(value, 1e-5) / rate);
        for (std::size_t i = 0; i < m_.y.size(); ++i) m_.next[i] = m_.y[i] + probe * m_.slope[0][i];
        flat_.evaluate(t_ + probe, m_.next, m_.error);
        for (std::size_t i = 0; i < m_.y.size(); ++i) m_.error[i] -= m_.slope[0][i];
        const double fastest = std::max(rate, FlatSystem::norm(m_.error, m_.scale) / probe);
        const double guess = std::pow(0.01 / fastest, 0.2);
        return !(left > 5 * guess) ? left : 2 * guess;
    }

    /// The slope at the start of an internal step is known; its share in the ledger depends on the length of the step.
    void first_stage(double step)
    {
        const double share = kDormandPrinceWeight[0] * step / h_;
        if (share != booked_) flat_.evaluate(t_, m_.y, m_.error, share - booked_);
        booked_ = share;
    }

    /// Computes stages 2 to 7, and the error in units of the tolerance.
    double attempt(double step)
    {
        for (std::size_t s = 1; s < kDormandPrinceStages; ++s)
        {
            stage_point(s, step);
            flat_.evaluate(t_ + kDormandPrinceNode[s] * step, m_.next, m_.slope[s], weight_of(s) * step / h_);
        }
        for (std::size_t i = 0; i < m_.y.size(); ++i)
        {
            double e = 0;
            for (std::size_t s = 0; s < kDormandPrinceStages; ++s) e += kError[s] * m_.slope[s][i];
            m_.error[i] = step * e;
        }
        scale(step);
        return FlatSystem::norm(m_.error, m_.scale);
    }

    void stage_point(std::size_t s, double step)
    {
        for (std::size_t i = 0; i < m_.y.size(); ++i)
        {
            double sum = 0;
            for (std::size_t j = 0; j < s; ++j) sum += kTable[s][j] * m_.slope[j][i];
            m_.next[i] = m_.y[i] + step * sum;
        }
    }

    void scale(double step)
    {
        flat_.sizes(m_.y, m_.slope[0], step, m_.sizes);
        FlatSystem::scales(tolerance_, m_.units, m_.sizes, m_.scale);
        flat_.sizes(m_.next, m_.slope[6], step, m_.sizes);
        for (std::size_t i = 0; i < m_.scale.size(); ++i)
            m_.scale[i] = std::max(m_.scale[i], tolerance_.absolute * m_.units[i] + tolerance_.relative * m_.sizes[i]);
    }

    /// Cancels the bookings of the stages after the first one of a rejected internal step. The slopes stay valid.
    void take_back(double step)
    {
        for (std::size_t s = 1; s + 1 < kDormandPrinceStages; ++s)
        {
            if (kDormandPrinceWeight[s] == 0) continue;
            stage_point(s, step);
            flat_.evaluate(t_ + kDormandPrinceNode[s] * step, m_.next, m_.error, -kDormandPrinceWeight[s] * step / h_);
        }
    }

    void accept(double step, bool last)
    {
        ++counts_.accepted;
        booked_ = 0;
        t_ = last ? h_ : t_ + step;
        std::swap(m_.y, m_.next);
        std::swap(m_.slope[0], m_.slope[6]);
    }

    double h_, t_;
    double booked_ = 0;  ///< share of the first stage of the present internal step
    Tolerance tolerance_;
    DormandPrinceMemory& m_;
    FlatSystem flat_;
    DormandPrinceCounts counts_;
};

}  // namespace

void DormandPrinceMemory::fit(std::size_t n)
{
    for (auto& s : slope) s.resize(n);
    for (auto* v : {&y, &next, &error, &units, &sizes, &scale}) v->resize(n);
}

void DormandPrince54Rows::describe(Schema& schema)
{
    describe_control(schema);
    schema.scratch(memory, "memory", "working vectors");
}

DormandPrinceCounts advance_by_dormand_prince(double h, const Tolerance& tolerance, std::int64_t max_substeps, DormandPrinceMemory& memory,
                                              DynamicSystem& system, double from)
{
    return DormandPrinceStep(h, tolerance, memory, system, from).run(max_substeps);
}

void report_dormand_prince_gave_up(const StepContext& start, Row row, const DormandPrinceCounts& counts)
{
    report_gave_up(start, row, counts, "raise max_substeps, loosen the tolerances, or use Solver/Radau5 if it is stiff");
}

void advance_dormand_prince54(const StepContext& context, Row row, DormandPrince54Rows& rows, DynamicSystem& system)
{
    const StepContext start = context;  // evaluations change the host's context
    const Tolerance tolerance{rows.relative_tolerance[row], rows.absolute_tolerance[row]};
    const DormandPrinceCounts counts = advance_by_dormand_prince(start.dt, tolerance, rows.max_substeps[row], rows.memory[row], system);
    if (is_trial(start)) return;
    rows.report(row, counts);
    if (counts.reached < start.dt) report_dormand_prince_gave_up(start, row, counts);
}

void ArticulatedRows::describe(Schema& schema)
{
    DormandPrince54Rows::describe(schema);
    ResolvedColumns::describe(schema);
}

void advance_articulated(const StepContext& context, Row row, ArticulatedRows& rows, DynamicSystem& system)
{
    const StepContext start = context;  // evaluations change the host's context
    auto* const minimal = dynamic_cast<MinimalCoordinates*>(&system);
    const std::string_view reason = minimal ? minimal->use_minimal_coordinates() : "the host has no minimal coordinates";
    if (reason.empty())
        rows.say(start, row, system.is_constrained() ? "Articulated" : "DormandPrince54");
    else
        rows.fall_back(start, row, Fallback::NotTree, "DormandPrince54", reason);
    advance_dormand_prince54(start, row, rows, system);
}

}  // namespace plab::solvers
