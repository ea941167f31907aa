#include "automatic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "exact.h"
#include "facts.h"
#include "rotation_splitting.h"
#include "runge_kutta4.h"

namespace plab::solvers
{
namespace
{

constexpr Tick kLookEvery = 16;
constexpr double kStiff = 1, kFast = 0.05, kFall = 0.25;
constexpr std::size_t kExponentialSize = 60;
constexpr Tolerance kTolerance{1e-9, 1e-12};
constexpr std::int64_t kMaxSubsteps = 100000;

std::string_view name_of(Choice choice)
{
    constexpr std::array<std::string_view, 5> names{"", "RungeKutta4", "RotationSplitting", "Exponential", "Radau5"};
    return names[static_cast<std::size_t>(choice)];
}

/// Facts of one group over a whole step.
struct Facts
{
    double spin = 0, stiffness = 0;  ///< h |w|, h |lambda|
    bool linear = false, constrained = false, small = false;
};

bool is_stiff(const Facts& facts, double share) { return facts.stiffness > share * kStiff && facts.stiffness > 4 * facts.spin; }

Choice needed(const Facts& facts, double share)
{
    if (is_stiff(facts, share)) return facts.linear && facts.small ? Choice::Exponential : Choice::Radau5;
    return facts.spin > share * kFast && !facts.constrained ? Choice::RotationSplitting : Choice::RungeKutta4;
}

/// How demanding: the two stiff methods are of one rank.
int rank(Choice choice) { return std::min(static_cast<int>(choice), static_cast<int>(Choice::Exponential)); }

std::string number(double x)
{
    std::string text = std::to_string(x);
    return x >= 1e6 ? "over 1e6" : text.substr(0, text.find('.') + 3);
}

std::string why(Choice choice, const Facts& facts)
{
    if (choice == Choice::Exponential) return "h |lambda| = " + number(facts.stiffness) + " is above 1 and the forces are linear";
    if (choice == Choice::Radau5) return "h |lambda| = " + number(facts.stiffness) + " is above 1";
    if (choice == Choice::RotationSplitting) return "h |w| = " + number(facts.spin) + " is above 0.05";
    return "h |w| = " + number(facts.spin) + " and h |lambda| = " + number(facts.stiffness) + " are small";
}

class Rule
{
public:
    Rule(const StepContext& start, Row row, AutomaticRows& rows, DynamicSystem& system)
        : start_(start), row_(row), rows_(rows), system_(system)
    {
    }

    /// Looks at a whole step before it is made. Pieces of a step are not looked at.
    void look()
    {
        const bool first = rows_.choice[row_] == undecided();
        const Tick tick = start_.tick, looked = rows_.looked[row_];
        if (first || rows_.latest[row_] != tick) rows_.latest[row_] = tick, rows_.step[row_] = start_.dt;
        if (start_.dt != rows_.step[row_]) return;
        if (!first && tick > looked && tick < looked + kLookEvery) return glance();
        if (first || tick != looked) begin_window();
        Facts facts = quick_facts();
        ExponentialMemory& m = rows_.memory[row_];
        const double rate = measure_stiffness(system_, start_.dt, {m.y, m.f0, m.slope, m.other, m.work, m.units, m.sizes});
        facts.stiffness = std::min(rate * start_.dt, 1e300);
        facts.linear = facts.small && is_stiff(facts, kFall) && would_be_exact(m);
        decide(facts);
    }

private:
    static std::int64_t undecided() { return static_cast<std::int64_t>(Choice::Undecided); }

    /// Whether this step is linear all along. The system is as it was afterwards.
    bool would_be_exact(ExponentialMemory& memory)
    {
        const bool fine = advance_by_exponential(start_.dt, true, true, memory, system_).fine;
        FlatSystem(system_).write(memory.y);
        return fine;
    }

    /// The spin only; stiffness as last measured.
    void glance()
    {
        Facts facts = quick_facts();
        const auto now = static_cast<Choice>(rows_.choice[row_]);
        if (rank(now) >= rank(Choice::Exponential)) return;
        facts.stiffness = 0;
        decide(facts);
    }

    Facts quick_facts()
    {
        Facts facts;
        facts.spin = std::min(fastest_spin(system_) * start_.dt, 1e300);
        facts.constrained = system_.is_constrained();
        facts.small = FlatSystem(system_).size() <= kExponentialSize;
        rows_.spin[row_] = facts.spin;
        return facts;
    }

    /// What was needed in the last window at most is the choice to start this one with.
    void begin_window()
    {
        rows_.looked[row_] = start_.tick;
        const auto need = static_cast<Choice>(rows_.need[row_]), now = static_cast<Choice>(rows_.choice[row_]);
        rows_.need[row_] = undecided();
        if (need == Choice::Undecided || rank(need) >= rank(now)) return;
        choose(need, "less was needed in the last 16 steps");
    }

    void decide(const Facts& facts)
    {
        if (facts.stiffness > 0) rows_.stiffness[row_] = facts.stiffness;
        const Choice need = needed(facts, 1), lower = needed(facts, kFall), now = static_cast<Choice>(rows_.choice[row_]);
        if (static_cast<std::int64_t>(lower) > rows_.need[row_]) rows_.need[row_] = static_cast<std::int64_t>(lower);
        // Between the two stiff methods the more general one wins.
        const bool harder = rank(need) > rank(now) || (rank(need) == rank(now) && need > now);
        if (harder) choose(need, why(need, facts));
    }

    void choose(Choice choice, const std::string& reason)
    {
        const bool as_expected = rows_.choice[row_] == undecided() && choice == Choice::RungeKutta4;
        rows_.choice[row_] = static_cast<std::int64_t>(choice);
        if (!as_expected)
            start_.emit(row_, "solver.chosen", Severity::Info, std::string(name_of(choice)) + ": " + reason,
                        {rows_.spin[row_], rows_.stiffness[row_], start_.dt});
    }

    const StepContext& start_;
    Row row_;
    AutomaticRows& rows_;
    DynamicSystem& system_;
};

/// True if the closed form holds for this group.
bool advance_exactly(const StepContext& start, Row row, AutomaticRows& rows, DynamicSystem& system)
{
    if (!system.forces_are_uniform() || system.is_constrained()) return false;
    const double spin = fastest_spin(system) * start.dt;
    if (!advance_in_closed_form(start.dt, system)) return false;
    if (is_trial(start)) return true;
    rows.spin[row] = std::min(spin, 1e300);
    if (rows.resolved[row] != "Exact") rows.resolved[row] = "Exact";
    return true;
}

void advance_chosen(Choice choice, const StepContext& start, Row row, AutomaticRows& rows, DynamicSystem& system)
{
    ExponentialMemory& memory = rows.memory[row];
    switch (choice)
    {
        case Choice::RotationSplitting:
            return advance_by_splitting(start.dt, 4, system);
        case Choice::Exponential:
            if (advance_by_exponential(start.dt, is_trial(start), true, memory, system).fine) return;
            [[fallthrough]];
        case Choice::Radau5:
        {
            const Radau5Counts counts = advance_by_radau(start.dt, is_trial(start), kTolerance, kMaxSubsteps, memory.radau, system);
            if (counts.reached < start.dt) tell_radau_gave_up(start, row, counts);
            return;
        }
        default:
            return advance_runge_kutta4(start, row, {}, system);
    }
}

}  // namespace

void AutomaticRows::describe(Schema& schema)
{
    const std::string codes = ": 1 RungeKutta4, 2 RotationSplitting, 3 Exponential, 4 Radau5; 0 none yet";
    schema.state(choice, "choice", unit::one, "the method in use" + codes).not_negative().at_most(4);
    schema.state(need, "need", unit::one, "the most demanding method needed since the last look" + codes).not_negative().at_most(4);
    schema.state(looked, "looked", unit::one, "step in which stiffness was measured last");
    schema.state(latest, "latest", unit::one, "step that was made last");
    schema.state(step, "step", unit::second, "length of that step").not_negative();
    schema.output(resolved, "resolved", unit::one, "the method that was used for the last group that was advanced");
    schema.output(spin, "spin", unit::one, "largest h |w| of the bodies, h the step");
    schema.output(stiffness, "stiffness", unit::one,
                  "h |lambda| as last measured, lambda the largest eigenvalue of the equations of motion");
    schema.scratch(memory, "memory", "working vectors and matrices");
}

void advance_automatic(const StepContext& context, Row row, AutomaticRows& rows, DynamicSystem& system)
{
    const StepContext start = context;  // evaluations change the host's
    if (advance_exactly(start, row, rows, system)) return;
    if (!is_trial(start)) Rule(start, row, rows, system).look();
    const auto choice = static_cast<Choice>(rows.choice[row]);
    if (!is_trial(start) && rows.resolved[row] != name_of(choice)) rows.resolved[row] = name_of(choice);
    advance_chosen(choice, start, row, rows, system);
}

}  // namespace plab::solvers
