#include "by_budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "cost_model.h"
#include "decision_costs.h"
#include "error_table.h"
#include "sight.h"
#include "spending.h"

namespace plab::governors
{
namespace
{

/// Pixels per metre: of what nobody sees, and of everything where there is no viewer.
constexpr double kUnseen = 1;
/// Exchanges that make a step too long are this many steps apart at least: fewer than one of 100.
constexpr double kRare = 128;
/// Steps after an exchange until the host tells what they cost: before that, what was exchanged may be too much already.
constexpr double kUntilMeasured = 5;

/// How much an error of the component counts, in pixels per metre.
double importance_of(const GovernedComponent& g, std::span<const Viewpoint> eyes, double look_ahead)
{
    constexpr double kMargin = 0.15;  // rad
    return std::max(kUnseen, pixels_per_metre(g, eyes, look_ahead, kMargin));
}

/// Parts of the cost of a level: a component costs in proportion to the objects on which it acts.
double weight_of(const GovernedComponent& g) { return std::max(1.0, static_cast<double>(g.objects)); }

/// s, of a step, exchanges and trials before it included.
double budget_of(const StepContext& context, Row row, const BudgetRows& governors)
{
    return governors.budget[row] > 0 ? governors.budget[row] : governors.share[row] * context.dt;
}

/// s, for the usual step: 99 of 100 shall take at most kMost times the budget.
double usual_budget(const StepContext& context, Row row, const BudgetRows& governors)
{
    constexpr double kMost = 1.1;
    return budget_of(context, row, governors) * std::min(1.0, kMost / std::max(1.0, governors.spread[row]));
}

/// Whether what takes so long (s) fits into the time that the usual step leaves; if not, whether a step may be too long again.
bool has_time(const StepContext& context, Row row, const BudgetRows& governors, double seconds)
{
    constexpr double kMost = 1.05;  // times the budget: 99 of 100 steps may take 1.1 times
    return governors.cost[row] + seconds <= kMost * budget_of(context, row, governors) ||
           context.time - governors.last_long[row] >= kRare * context.dt;
}

/// A boundary after the other governors look, if they look as often: what they exchange costs time too, so both together would make one
/// step too long.
bool is_due(const StepContext& context, double every)
{
    StepContext before = context;
    before.time -= context.dt;
    return context.tick == 0 || (context.tick > 1 && due(before, every));
}

/// m. NaN: it cannot be told.
double metres_of(const LevelError& error, double radius)
{
    return std::isnan(error.distance) ? error.angle * (std::isfinite(radius) ? radius : 1.0) : error.distance;
}

/// One look of a governor by budget.
class BudgetLook
{
public:
    BudgetLook(const StepContext& context, Row row, BudgetRows& governors, LevelControl& control)
        : context_(context),
          row_(row),
          g_(governors),
          control_(control),
          look_(context, row, governors.watch, control),
          levels_(static_cast<std::size_t>(look_.finest() + 1)),
          budget_(budget_of(context, row, governors)),
          usual_(usual_budget(context, row, governors)),
          cost_(governors.cost[row] > kLeastCost ? governors.cost[row] : 0),
          model_(governors.costs[row], levels_),
          table_(governors.errors[row], levels_)
    {
        for (const GovernedComponent& c : look_.watched())
            if (c.level >= 0) whole_ += weight_of(c);
    }

    bool watches_nothing() const { return look_.watched().empty(); }
    void begin_cheaply();
    void learn_costs();
    void try_next_level();
    void learn_errors_of_new_kinds();
    void choose();
    void publish();

private:
    struct Change
    {
        std::size_t component;
        std::int32_t level;
        double worth;    ///< pixels per second; of a cheaper level infinite: it has to come first
        double seconds;  ///< that a step costs more
    };
    void try_levels(std::size_t k);
    void prefer_new_kind(std::int64_t stride);
    Reals parts_at_levels() const;
    LevelPrices prices() const;
    double seconds_to_spend(const LevelPrices& price) const;
    std::vector<Change> plan() const;
    std::size_t exchanges_now(const std::vector<Change>& changes) const;
    double exchange_cost(std::size_t n) const;
    double long_step_after(const std::vector<Change>& changes, std::size_t n) const;
    double error_of(std::size_t k, std::int32_t level) const;
    std::string reason(const Change& change) const;
    bool is_over() const { return cost_ > usual_; }
    bool has_room() const { return cost_ < usual_ * (1 - g_.headroom[row_]); }
    double importance(std::size_t k) const { return importance_of(look_.watched()[k], control_.viewpoints(), g_.watch.every[row_]); }

    const StepContext& context_;
    Row row_;
    BudgetRows& g_;
    LevelControl& control_;
    Look look_;
    std::size_t levels_;
    double budget_, usual_, cost_;
    CostModel model_;
    ErrorTable table_;
    double whole_ = 0;  ///< sum of weights
};

/// Before anything is known of costs, the first step must not take longer than the scene can help.
void BudgetLook::begin_cheaply()
{
    for (std::size_t k = 0; k < look_.watched().size(); ++k)
        if (look_.watched()[k].level > 0 && look_.may_choose(k, 0)) (void)look_.choose(k, 0, "nothing is known yet of what levels cost");
}

/// The part of all work that is done with each level; sum 1.
Reals BudgetLook::parts_at_levels() const
{
    Reals out(levels_, 0.0);
    for (const GovernedComponent& c : look_.watched())
        if (c.level >= 0) out[static_cast<std::size_t>(c.level)] += weight_of(c) / whole_;
    return out;
}

void BudgetLook::learn_costs()
{
    if (whole_ > 0) model_.update(parts_at_levels(), cost_);
    Reals& trials = g_.trial_costs[row_];
    for (std::size_t l = 1; l < std::min(trials.size(), levels_); ++l)
        if (trials[l] > 0 && trials[l - 1] > 0) model_.update_difference(l, whole_ * (trials[l] - trials[l - 1]));
    trials.clear();
}

/// The error of each level of one component, as the sum of what each level departs from the next finer one.
void BudgetLook::try_levels(std::size_t k)
{
    const GovernedComponent& c = look_.watched()[k];
    Reals errors(levels_, 0.0);
    for (std::size_t l = levels_ - 1; l-- > 0;)
    {
        const double e = metres_of(control_.error(row_, k, static_cast<std::int32_t>(l), g_.interval[row_]), c.radius);
        if (std::isnan(e)) return;
        errors[l] = errors[l + 1] + e;
    }
    table_.add(c.objects, c.level, errors);
}

/// The next one in the list whose kind has not been tried with its present level comes first.
void BudgetLook::prefer_new_kind(std::int64_t stride)
{
    const auto size = static_cast<std::int64_t>(look_.watched().size());
    for (std::int64_t n = 0, k = g_.next_trial[row_]; n < size; ++n, k += stride)
        if (const GovernedComponent& c = look_.watched()[static_cast<std::size_t>(k % size)];
            c.level >= 0 && c.objects > 0 && table_.trials(c.objects, c.level) == 0)
        {
            g_.next_trial[row_] = k % size;
            return;
        }
}

/// One level at a boundary, from the one below the most exact one to the cheapest one. The sum is over when all have been tried.
void BudgetLook::try_next_level()
{
    const auto size = static_cast<std::int64_t>(look_.watched().size());
    Reals& sum = g_.partial[row_];
    if (sum.empty() || sum.size() >= levels_)
    {
        // A stride that visits all, far from one another.
        std::int64_t stride = std::max<std::int64_t>(1, size * 5 / 13);
        while (std::gcd(stride, size) != 1) ++stride;
        g_.next_trial[row_] += stride, sum.assign(1, 0.0);
        prefer_new_kind(stride);
    }
    const auto k = static_cast<std::size_t>(g_.next_trial[row_] % size);
    const GovernedComponent& c = look_.watched()[k];
    const std::size_t level = levels_ - 1 - sum.size();
    if (g_.cost[row_] + g_.trial[row_] > budget_) g_.last_long[row_] = context_.time;
    sum.push_back(sum.back() + metres_of(control_.error(row_, k, static_cast<std::int32_t>(level), g_.interval[row_]), c.radius));
    if (level > 0 && !std::isnan(sum.back())) return;
    if (!std::isnan(sum.back())) table_.add(c.objects, c.level, Reals(sum.rbegin(), sum.rend()));
    sum.clear(), --g_.trials_left[row_], g_.next_trial[row_] %= size;
}

/// So that nothing is chosen without knowing what it buys.
void BudgetLook::learn_errors_of_new_kinds()
{
    constexpr int kFew = 3;
    constexpr std::size_t kMost = 24;
    std::array<std::pair<std::uint32_t, int>, kMost> met;  // of kinds that are new in this look: objects, trials
    std::size_t kinds = 0, trials = 0;
    for (std::size_t k = 0; k < look_.watched().size() && trials < kMost; ++k)
    {
        const GovernedComponent& c = look_.watched()[k];
        if (c.level < 0 || c.objects == 0) continue;
        const auto end = met.begin() + static_cast<std::ptrdiff_t>(kinds);
        const auto kind = std::find_if(met.begin(), end, [&](const auto& m) { return m.first == c.objects; });
        if (kind == end && table_.trials(c.objects) > 0) continue;
        if (kind == end) met[kinds++] = {c.objects, 0};
        if (kind->second >= kFew) continue;
        ++kind->second, ++trials;
        try_levels(k);
    }
}

LevelPrices BudgetLook::prices() const
{
    constexpr double kDoubtful = 0.5, kWorst = 20;  // of what a level is taken to cost; of what a step costs now
    constexpr double kHardly = 0.02;                // of all work: steps have not told yet what the level costs
    const Reals parts = parts_at_levels();
    const auto used = std::find_if(parts.rbegin(), parts.rend(), [](double part) { return part >= kHardly; });
    const auto untried = static_cast<std::size_t>(parts.rend() - used);  // the first level above those in use
    LevelPrices out;
    for (std::size_t l = 0; l < levels_; ++l)
    {
        const bool doubtful = model_.deviation(l) > kDoubtful * model_.cost(l);
        const double likely = model_.cost(l) + (l >= untried ? model_.deviation(l) : 0.0);
        out.expected.push_back(likely), out.worst.push_back(doubtful ? std::max(likely, kWorst * cost_) : likely);
    }
    return out;
}

/// For all components together. Between the budget and its headroom what is spent already is spent otherwise at most, so that a level does
/// not come and go with each measurement.
double BudgetLook::seconds_to_spend(const LevelPrices& price) const
{
    const double goal = usual_ * (1 - 0.5 * g_.headroom[row_]);
    const Reals parts = parts_at_levels();
    double modelled = 0;
    for (std::size_t l = 0; l < levels_; ++l) modelled += parts[l] * price.expected[l];
    // Half of what the model does not explain is taken for chance.
    const double room = goal - 0.5 * (cost_ + modelled);
    return modelled + (is_over() || has_room() ? room : std::max(0.0, room));
}

std::vector<BudgetLook::Change> BudgetLook::plan() const
{
    std::vector<Candidate> candidates;
    std::vector<std::size_t> component;
    std::map<std::pair<std::uint32_t, std::int32_t>, Reals> known;  // errors by kind: objects, present level
    for (std::size_t k = 0; k < look_.watched().size(); ++k)
    {
        const GovernedComponent& c = look_.watched()[k];
        if (c.level < 0) continue;
        const auto [kind, is_new] = known.try_emplace({c.objects, c.level});
        if (is_new) kind->second = table_.errors(c.objects, c.level);
        candidates.push_back({is_over() || look_.rested(k) ? 0 : c.level, c.level, weight_of(c) / whole_, importance(k), kind->second});
        component.push_back(k);
    }
    const LevelPrices price = prices();
    const std::vector<std::int32_t> levels = choose_levels(candidates, price, seconds_to_spend(price), g_.tolerance[row_]);
    std::vector<Change> out;
    for (std::size_t n = 0; n < candidates.size(); ++n)
    {
        const Candidate& c = candidates[n];
        if (levels[n] == c.present) continue;
        const auto from = static_cast<std::size_t>(c.present), to = static_cast<std::size_t>(levels[n]);
        const double seconds = c.weight * (price.expected[to] - price.expected[from]);
        constexpr double kFirst = std::numeric_limits<double>::infinity();
        const double worth = c.scale * (c.errors[from] - c.errors[to]) / std::max(kLeastCost, seconds);
        out.push_back({component[n], levels[n], to < from ? kFirst : worth, seconds});
    }
    std::stable_sort(out.begin(), out.end(), [](const Change& a, const Change& b) { return a.worth > b.worth; });
    return out;
}

/// s, that an exchange of n components takes; 0: nothing is known of it.
double BudgetLook::exchange_cost(std::size_t n) const
{
    const Reals& learnt = g_.exchange[row_];
    return n == 0 || learnt.size() < 2 ? 0 : learnt[0] + static_cast<double>(n) * learnt[1];
}

/// s, that the usual step costs with the first n changes, and these with it.
double BudgetLook::long_step_after(const std::vector<Change>& changes, std::size_t n) const
{
    double out = cost_ + exchange_cost(n);
    for (std::size_t k = 0; k < n; ++k) out += changes[k].seconds;
    return out;
}

/// How many of the changes are made at this boundary. Until it is known what an exchange costs, a few tell it.
std::size_t BudgetLook::exchanges_now(const std::vector<Change>& changes) const
{
    const std::size_t all = changes.size();
    constexpr std::size_t kFirst = 16;
    if (cost_ > budget_) return all;
    if (g_.exchange[row_].size() < 2) return std::min(all, kFirst);
    // The worthiest come first, and each exchange tells better what the next ones cost.
    double cost = long_step_after(changes, all);
    std::size_t fit = all;
    for (; fit > 0 && cost > budget_; --fit) cost -= exchange_cost(fit) - exchange_cost(fit - 1) + changes[fit - 1].seconds;
    if (fit > 0) return fit;
    return is_over() || context_.time - g_.last_long[row_] >= kRare * context_.dt ? all : 0;
}

double BudgetLook::error_of(std::size_t k, std::int32_t level) const
{
    const GovernedComponent& c = look_.watched()[k];
    return table_.errors(c.objects, c.level)[static_cast<std::size_t>(level)];
}

std::string BudgetLook::reason(const Change& change) const
{
    const GovernedComponent& c = look_.watched()[change.component];
    const double scale = importance(change.component);
    return std::string(has_room() ? "there is room: " : "") + "a step takes " + brief(1e3 * cost_) + " ms of " + brief(1e3 * budget_) +
           " ms; error " + brief(scale * error_of(change.component, c.level)) + " -> " +
           brief(scale * error_of(change.component, change.level)) + " pixels";
}

void BudgetLook::choose()
{
    const std::vector<Change> changes = plan();
    const std::size_t now = exchanges_now(changes);
    for (std::size_t n = 0; n < now; ++n)
    {
        const Change& change = changes[n];
        (void)look_.choose(change.component, change.level, reason(change), is_over());
        control_.tell(row_, change.component, error_of(change.component, change.level), "m", std::numeric_limits<double>::quiet_NaN());
    }
    g_.waiting[row_] = static_cast<std::int64_t>(changes.size() - now);
    if (now > 0 && long_step_after(changes, now) > budget_) g_.last_long[row_] = context_.time;
    for (std::size_t n = 0; n < now; ++n) g_.cost[row_] += changes[n].seconds;
    g_.retry[row_] = now > 0 ? context_.time + (kUntilMeasured - 0.5) * context_.dt : g_.last_long[row_] + kRare * context_.dt;
}

void BudgetLook::publish()
{
    g_.spent[row_] = cost_ / usual_;
    g_.given_up[row_] = static_cast<std::int64_t>(static_cast<double>(look_.watched().size()) - g_.watch.count[row_].back());
    double all = 0, lost = 0;
    for (std::size_t k = 0; k < look_.watched().size(); ++k)
    {
        const double scale = importance(k);
        all += scale;
        if (look_.watched()[k].level < look_.finest()) lost += scale;
    }
    g_.lost[row_] = all > 0 ? lost / all : 0;
}

}  // namespace

void keep_budget(const StepContext& context, Row row, BudgetRows& governors, LevelControl& control)
{
    learn_exchange(governors.exchange[row], governors.exchange_cost[row], governors.cost[row]);
    learn_trial(governors.trial[row], governors.trial_time[row], governors.cost[row]);
    const double told = governors.step_cost[row];
    const bool is_new = told != governors.last_step_cost[row], knows_costs = !governors.costs[row].empty();
    if (is_new) governors.cost[row] = governors.last_step_cost[row] = told;
    const bool measured = told > kLeastCost;
    // What was chosen may turn out to cost too much before the next look is due.
    const bool is_late = is_new && told > usual_budget(context, row, governors);
    const bool looks = is_due(context, governors.watch.every[row]) || (measured && !knows_costs) || is_late;
    const bool tries =
        governors.trials_left[row] > 0 && governors.spent[row] < 1 && has_time(context, row, governors, governors.trial[row]);
    const bool goes_on = governors.waiting[row] > 0 && context.time >= governors.retry[row];
    if (!looks && !tries && !goes_on && !is_new) return;
    BudgetLook look(context, row, governors, control);
    if (look.watches_nothing()) return;
    if (!knows_costs || looks) look.learn_errors_of_new_kinds();
    if (!measured && !knows_costs) return look.begin_cheaply(), look.publish();
    if (!measured) return;
    if (is_new || !knows_costs) look.learn_costs();
    if (looks) governors.trials_left[row] = governors.trials[row];
    if (looks || goes_on)
        look.choose();
    else if (tries)
        look.try_next_level();
    if (looks) look.publish();
}

}  // namespace plab::governors
