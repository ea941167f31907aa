#include "automatic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "exact.h"
#include "fixed_step.h"
#include "plab/contact_pieces.h"
#include "plab/minimal_coordinates.h"
#include "plab/number_text.h"
#include "rotation_splitting.h"
#include "runge_kutta4_parts.h"
#include "stiffness.h"

namespace plab::solvers
{
namespace
{

constexpr double kFast = 0.05;
/// Bodies that joints hold and that turn further than this in a step (rad) are advanced in parts of kTurnOfPart: a top of 300 rad/s on a
/// ball joint gained ten thousand times its energy in a second with one step of 1/60 s after the other.
constexpr double kMostTurn = 0.2, kTurnOfPart = 0.1;
constexpr double kMostTurnParts = 4000;
constexpr std::size_t kExponentialSize = 60, kRadauSize = 200;
/// Of a larger group than `kManySize`, parts of |h lambda| = 0.4 cost less than implicit steps while they are at most so many: an implicit
/// step takes about as many evaluations as there are numbers, and the cube of that in products.
constexpr std::size_t kManySize = kExponentialSize;
constexpr double kPart = 0.4;
constexpr double kMostParts = 16;
/// A step over a switch of contacts, whose slopes tell nothing about how many would do.
constexpr std::int64_t kMostPartsOfSwitch = 8;
/// Above kRadauSize, internal steps with control of their error are the only other way, and dearer still: 80 ms instead of 10 ms a step
/// where a chain of 100 links under a heavy ball is a taut string with |h lambda| = 7.
constexpr double kMostPartsOfLarge = 64;
/// Trees of joints of up to so many numbers are described by their joints where they are stiff; those of longer chains would be too many
/// for an implicit step as well.
constexpr std::size_t kMinimalSize = 600;
/// RungeKutta4 is stable up to |h lambda| = 2.8.
constexpr double kLimit = 2;
constexpr std::int64_t kFewestParts = 4, kFewestOverJumps = 32;
constexpr Tolerance kTolerance{1e-9, 1e-12};
/// After so many internal steps the rest of the step is made without control of its error. A bridge whose planks are as long as its span
/// has no smooth motion at all; nor has what a script pushes back from both sides of a line.
constexpr std::int64_t kMostSubsteps = 1000;
/// After so many, as a trial: if these have not come as far as 4 times kMostSubsteps of them would have to, the others are not made.
constexpr std::int64_t kTrialSubsteps = 100;
/// So many implicit steps show whether these find the way between two forces that jump to and fro: they come farther than this share of the
/// step then.
constexpr std::int64_t kFewSubsteps = 6;
constexpr double kLittle = 1.0 / 16;
/// Implicit steps of which few are refused get to the end of the step, however short they are.
constexpr std::int64_t kMostIfSmooth = 20000;
constexpr double kMostRefused = 0.25;
constexpr double kHopeless = static_cast<double>(kTrialSubsteps) / (4.0 * static_cast<double>(kMostSubsteps));

/// In order of increasing cost.
enum class Method : std::size_t
{
    Exact,
    RungeKutta4,
    RotationSplitting,
    Exponential,
    Radau5,
    DormandPrince54,
    RungeKutta4Parts,
    OverJumps,
};
constexpr std::array<std::string_view, 8> kNames{"Exact",  "RungeKutta4",     "RotationSplitting",    "Exponential",
                                                 "Radau5", "DormandPrince54", "RungeKutta4 in parts", "RungeKutta4 over jumps"};

std::int64_t bit_of(Method method) { return std::int64_t{1} << static_cast<int>(method); }

std::string number(double x) { return rounded_text(x, 2); }

class Choice
{
public:
    Choice(const StepContext& start, Row row, AutomaticRows& rows, DynamicSystem& system)
        : start_(start), h_(start.dt), trial_(is_trial(start)), row_(row), rows_(rows), m_(rows.memory[row]), system_(system)
    {
    }

    void advance()
    {
        begin_turn();
        if (is_free() && advance_in_closed_form(h_, system_)) return say(Method::Exact);
        if (system_.is_undersampled()) return advance_undersampled();
        spin_ = fastest_spin(system_) * h_;
        StageSlopes slopes(system_);
        const bool fast = spin_ > kFast && !system_.is_constrained(), turns = spin_ > kMostTurn && system_.is_constrained();
        const bool at_once = !fast && !turns && expects_soft();
        if (at_once)
            advance_by_runge_kutta4(h_, system_, &slopes);
        else
            find_slopes(h_, system_, slopes);
        const Stiffness found = stiffness_of(system_, h_, slopes);
        stiffness_ = found.value;
        remember(!found.too_much);
        if (found.too_much)
        {
            if (at_once) take_back_runge_kutta4(h_, system_, slopes);
            return are_only_contacts() ? advance_over_a_switch() : advance_stiff();
        }
        if (turns) return advance_in_parts(std::min(spin_ / kTurnOfPart, kMostTurnParts));
        say(fast ? Method::RotationSplitting : Method::RungeKutta4);
        if (fast) return advance_by_splitting(h_, 4, system_);
        if (!at_once) advance_by_runge_kutta4(h_, system_);
    }

    /// Returns false if some group may need another method; then everything is unchanged.
    bool advance_together()
    {
        begin_turn();
        if (is_free() && advance_in_closed_form(h_, system_))
        {
            say(Method::Exact);
            return true;
        }
        spin_ = fastest_spin(system_) * h_;
        if (spin_ > kFast || system_.is_constrained() || system_.quantity_count() > 0) return false;
        StageSlopes slopes(system_);
        const bool at_once = expects_soft();
        if (at_once)
            advance_by_runge_kutta4(h_, system_, &slopes);
        else
            find_slopes(h_, system_, slopes);
        const Stiffness found = stiffness_of(system_, h_, slopes, true);
        stiffness_ = found.value;
        remember(!found.too_much);
        if (found.too_much)
        {
            if (at_once) take_back_runge_kutta4(h_, system_, slopes);
            system_.evaluate(0, 0);
            return false;
        }
        say(Method::RungeKutta4);
        if (!at_once) advance_by_runge_kutta4(h_, system_);
        return true;
    }

private:
    bool are_only_contacts() const
    {
        const auto* const pieces = dynamic_cast<const ContactPieces*>(&system_);
        return pieces && pieces->are_only_contacts();
    }
    bool is_free() const { return system_.forces_are_uniform() && !system_.is_constrained(); }
    void begin_turn()
    {
        if (trial_ || rows_.step[row_] == start_.tick) return;
        rows_.step[row_] = start_.tick, m_.before = rows_.last_methods[row_], rows_.last_methods[row_] = 0, m_.call = 0;
    }

    /// Whether the group that was advanced at this position in the last step was not stiff. This influences only the bookkeeping: if so,
    /// the step of RungeKutta4 is booked at once; otherwise it is checked first, because undoing the bookings of a diverging step would
    /// leave rounding errors of their size.
    bool expects_soft() const
    {
        const Integers& soft = rows_.soft_turns[row_];
        if (trial_) return std::find(soft.begin(), soft.end(), 0) == soft.end();  // calls are not counted
        return m_.call < soft.size() && soft[m_.call] != 0;
    }
    void remember(bool soft)
    {
        if (trial_) return;
        Integers& turns = rows_.soft_turns[row_];
        if (m_.call == turns.size()) turns.push_back(0);
        turns[m_.call++] = soft ? 1 : 0;
    }

    void advance_undersampled()
    {
        remember(false);
        say(Method::RungeKutta4);
        advance_by_runge_kutta4(h_, system_);
    }

    /// Of the explicit methods of order 4 splitting has the smallest error where forces are not smooth. With joints a few parts, without
    /// looking whether they are short enough: no part that has a switch within it is.
    void advance_over_a_switch()
    {
        if (system_.is_constrained())
        {
            say(Method::RungeKutta4Parts);
            return finish_by_runge_kutta4(h_, 0, std::clamp<std::int64_t>(parts_of(1, kPart), 1, kMostPartsOfSwitch), system_);
        }
        say(Method::RotationSplitting);
        advance_by_splitting(h_, 4, system_);
    }

    void advance_stiff()
    {
        if (FlatSystem(system_).size() <= kMinimalSize) describe_by_joints();
        if (advance_by_exponential(h_, true, kExponentialSize, m_.exponential, system_).fine) return say(Method::Exponential);
        const std::size_t size = FlatSystem(system_).size();
        if (size > kManySize && stiffness_ <= kPart * (size > kRadauSize ? kMostPartsOfLarge : kMostParts))
            return advance_in_parts(stiffness_ / kPart);
        if (size > kRadauSize) return advance_explicitly(0);
        advance_implicitly();
    }

    /// Radau5, as long as there is a prospect that it gets to the end of the step.
    void advance_implicitly()
    {
        say(Method::Radau5);
        prospect_ = {};
        const Radau5Counts counts = advance_by_radau(h_, kTolerance, kMostIfSmooth, m_.exponential.radau, system_,
                                                     [this](const Radau5Counts& c) { return gets_on(c); });
        if (!(counts.reached < h_) || system_.interrupted()) return;
        // Measured across a jump, |h lambda| tells nothing; probes do.
        if (prospect_.probed.grows && stiffness_ > kLimit * static_cast<double>(kMostSubsteps))
        {
            if (!trial_) report_radau_gave_up(start_, row_, counts);
            return;
        }
        say(Method::OverJumps);
        if (!prospect_.probed.grows) return finish_by_runge_kutta4(h_, counts.reached, kFewestOverJumps, system_);
        finish_without_control(counts.reached, kFewestOverJumps);
    }

    /// Few are refused while the motion is smooth. Of the others some thousand may pass jumps, if the first hundred have got anywhere.
    bool gets_on(const Radau5Counts& counts)
    {
        const std::int64_t made = counts.accepted + counts.refused;
        const auto slides = [&]
        {
            prospect_.probed = probe(counts.reached, m_.exponential.radau.y, h_ / kFewestOverJumps, m_.probe, system_);
            return prospect_.probed.slides;
        };
        if (made == kFewSubsteps && counts.reached < kLittle * h_) return !slides();
        if (made % kTrialSubsteps != 0) return true;
        if (made == kTrialSubsteps) prospect_.is_good = counts.reached > kHopeless * h_;
        const std::int64_t refused = std::exchange(prospect_.refused, counts.refused);
        const bool smooth = static_cast<double>(counts.refused - refused) < kMostRefused * static_cast<double>(kTrialSubsteps);
        return smooth || (!slides() && prospect_.is_good && made < kMostSubsteps);
    }

    void finish_without_control(double from, std::int64_t fewest)
    {
        finish_by_runge_kutta4(h_, from, std::max(fewest, parts_of((h_ - from) / h_, kLimit)), system_);
    }

    /// A robot of six hinges has 72 numbers as bodies, and 12 as angles and rates: that is what an implicit step costs.
    void describe_by_joints()
    {
        auto* const minimal = system_.is_constrained() ? dynamic_cast<MinimalCoordinates*>(&system_) : nullptr;
        if (!minimal) return;
        system_.evaluate(0, 0);  // trees of joints are recognised at the start
        (void)minimal->use_minimal_coordinates();
    }

    void advance_in_parts(double fewest)
    {
        say(Method::RungeKutta4Parts);
        const auto parts = static_cast<std::int64_t>(std::ceil(fewest));
        const double reached = advance_by_runge_kutta4_parts(h_, parts, system_).reached;
        if (reached < h_ && !system_.interrupted()) advance_explicitly(reached);
    }

    void advance_explicitly(double from)
    {
        say(Method::DormandPrince54);
        DormandPrinceCounts counts = advance_by_dormand_prince(h_, kTolerance, kTrialSubsteps, m_.dormand, system_, from);
        if (counts.reached < h_ && counts.reached - from > kHopeless * (h_ - from) && !system_.interrupted())
        {
            const DormandPrinceCounts more =
                advance_by_dormand_prince(h_, kTolerance, kMostSubsteps - kTrialSubsteps, m_.dormand, system_, counts.reached);
            counts.accepted += more.accepted, counts.refused += more.refused, counts.evaluations += more.evaluations;
            counts.reached = more.reached;
        }
        if (!(counts.reached < h_) || system_.interrupted()) return;
        if (!trial_)
            report_gave_up(start_, row_, counts,
                           "name a solver, take shorter steps, or look for joints that leave a mechanism just no room to move",
                           "the rest is made by RungeKutta4 without control of its error");
        finish_without_control(counts.reached, kFewestParts);
    }

    /// Parts of a share of the step in each of which |h lambda| is `most`.
    std::int64_t parts_of(double share, double most) const
    {
        return static_cast<std::int64_t>(std::min(std::ceil(stiffness_ * share / most), static_cast<double>(kMostSubsteps)));
    }

    std::string why(Method method) const
    {
        static constexpr const char* kOfContacts = ", of contacts alone, for which the step is divided already";
        const std::string stiff = "|h lambda| = " + number(stiffness_) + " is above 0.5";
        switch (method)
        {
            case Method::Exact:
                return "forces are uniform and no joints hold";
            case Method::Exponential:
                return stiff + " and the forces are linear";
            case Method::Radau5:
                return stiff;
            case Method::RungeKutta4Parts:
                if (spin_ > kMostTurn && system_.is_constrained() && !(stiffness_ > 0.5))
                    return "h |w| = " + number(spin_) + " is above " + number(kMostTurn) + ", of bodies that joints hold";
                if (are_only_contacts()) return stiff + kOfContacts;
                return stiff + "; a group of " + std::to_string(FlatSystem(system_).size()) +
                       " numbers costs less in short steps than in an implicit one";
            case Method::DormandPrince54:
                return stiff + "; " + std::to_string(FlatSystem(system_).size()) + " numbers in a group are too many for implicit steps (" +
                       std::to_string(kRadauSize) + "; after a jump " + std::to_string(kManySize) + "), so internal steps are short";
            case Method::OverJumps:
                return stiff +
                       ", and internal steps with control of their error do not get on, as where forces jump to and fro; name a solver of "
                       "fixed steps, or let forces change gradually";
            case Method::RotationSplitting:
                if (!(spin_ > kFast)) return stiff + kOfContacts;
                return "h |w| = " + number(spin_) + " is above 0.05";
            default:
                if (system_.is_undersampled()) return "contacts need more substeps than are allowed, whatever the method";
                return "h |w| = " + number(spin_) + " and |h lambda| = " + number(stiffness_) + " are small";
        }
    }

    void say(Method method)
    {
        if (trial_) return;
        if (spin_ >= 0) rows_.spin[row_] = std::min(spin_, 1e300), rows_.stiffness[row_] = std::min(stiffness_, 1e300);
        rows_.last_methods[row_] |= bit_of(method);
        if (const std::int64_t all = m_.before | rows_.last_methods[row_]; all != m_.shown) show(all);
        if ((rows_.methods[row_] & bit_of(method)) != 0) return;
        rows_.methods[row_] |= bit_of(method);
        rows_.reason[row_] = std::string(kNames[static_cast<std::size_t>(method)]) + ": " + why(method);
        if (method == Method::RungeKutta4 || method == Method::Exact) return;
        const bool told = method == Method::DormandPrince54 || method == Method::OverJumps;
        const Severity severity = told ? Severity::Warning : Severity::Info;
        start_.emit(row_, "solver.chosen", severity, rows_.reason[row_], {spin_, stiffness_, h_});
    }

    void show(std::int64_t methods)
    {
        m_.shown = methods;
        std::string& out = rows_.resolved[row_];
        out.clear();
        for (std::size_t i = 0; i < kNames.size(); ++i)
            if ((methods & (std::int64_t{1} << i)) != 0) out.append(out.empty() ? "" : ", ").append(kNames[i]);
    }

    const StepContext& start_;
    double h_;
    bool trial_;
    Row row_;
    AutomaticRows& rows_;
    AutomaticMemory& m_;
    DynamicSystem& system_;
    double spin_ = -1, stiffness_ = 0;  ///< spin below 0: not measured
    struct
    {
        std::int64_t refused = 0;  ///< when last looked at
        bool is_good = false;
        Probed probed;
    } prospect_;
};

}  // namespace

void AutomaticRows::describe(Schema& schema)
{
    schema.output(resolved, "resolved", unit::one, "the methods with which groups were advanced in the last steps");
    schema.output(reason, "reason", unit::one, "the reason for choosing the latest method");
    schema.output(spin, "spin", unit::one, "largest h |w| of the bodies, h the step, of the last group that forces act on");
    schema.output(stiffness, "stiffness", unit::one, "|h lambda| of that group, lambda the largest eigenvalue that its motion excites");
    schema.output(
        methods, "methods", unit::one,
        "used since the run began, a sum: 1 Exact, 2 RungeKutta4, 4 RotationSplitting, 8 Exponential, 16 Radau5, 32 DormandPrince54, "
        "64 RungeKutta4 in parts, 128 RungeKutta4 over jumps");
    schema.output(last_methods, "last_methods", unit::one, "used in the last step, as the same sum");
    schema.output(step, "step", unit::one, "the step to which these outputs belong; -1: none yet").or_else(-1);
    schema.output(soft_turns, "soft_turns", unit::one,
                  "group by group in the order of the last steps, 1: was not stiff, so its next step is booked at once");
    schema.scratch(memory, "memory", "working vectors and matrices");
}

Result<void> advance_together(const StepContext& context, Row row, AutomaticRows& rows, DynamicSystem& system)
{
    const StepContext start = context;  // evaluations change the host's context
    if (Choice(start, row, rows, system).advance_together()) return {};
    return reason("some of the groups may need another method");
}

void advance_automatic(const StepContext& context, Row row, AutomaticRows& rows, DynamicSystem& system)
{
    const StepContext start = context;  // evaluations change the host's context
    Choice(start, row, rows, system).advance();
}

}  // namespace plab::solvers
