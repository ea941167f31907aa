#include "by_error.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include "sight.h"

namespace plab::governors
{
namespace
{

constexpr double kHidden = 0;
/// Times `every`: until a component that has the most exact level is measured again. It promises nothing, and measuring it at each look
/// would cost more than a cheaper level saves.
constexpr double kIdle = 4;
/// Times that, where the next cheaper level is far from keeping the bound.
constexpr double kSeldom = 4;

Entries::iterator place_of(Entries& next, std::string_view id)
{
    return std::lower_bound(next.begin(), next.end(), id, [](const Entry& e, std::string_view name) { return e.name < name; });
}

double pick(const LevelError& error, const std::string& unit, double scale)
{
    if (unit == "rad") return error.angle;
    if (unit == "W") return error.power;
    return unit == "pixels" ? scale * error.distance : error.distance;
}

/// One component in one look.
class Measurement
{
public:
    Measurement(Row row, std::size_t index, double scale, ErrorRows& governors, LevelControl& control)
        : row_(row), index_(index), scale_(scale), governors_(governors), control_(control)
    {
    }
    /// In the governor's unit. NaN: it cannot be told. Beyond `enough` the trial may end, and what it has shown so far is returned.
    double at(std::int32_t level, double enough = std::numeric_limits<double>::infinity())
    {
        const std::string& unit = governors_.unit[row_];
        const bool told = unit != "W" && std::isfinite(enough);
        governors_.enough[row_] = told ? enough / (unit == "pixels" ? scale_ : 1.0) : 0.0;
        const double e = pick(control_.error(row_, index_, level, governors_.interval[row_]), unit, scale_);
        ++governors_.measured[row_], ++tried_;
        governors_.unknown[row_] += std::isnan(e) ? 1 : 0;
        return e;
    }
    /// How many levels were tried, each beside the next finer one.
    std::size_t tried() const { return tried_; }
    /// What cannot be told is taken for too much.
    bool fits(double error, double reserve = 0) const { return error * governors_.safety[row_] * (1 + reserve) <= governors_.bound[row_]; }
    /// What does not fit exceeds this.
    double most(double reserve = 0) const { return governors_.bound[row_] / (governors_.safety[row_] * (1 + reserve)); }

private:
    Row row_;
    std::size_t index_;
    double scale_;
    ErrorRows& governors_;
    LevelControl& control_;
    std::size_t tried_ = 0;
};

/// What a sample of the watched components tells of all of them: by level, how many were sampled, and how many of these kept the bound.
/// Older samples fade.
class Sample
{
public:
    Sample(Row row, ErrorRows& governors, std::size_t levels) : seen_(governors.sampled[row]), kept_(governors.sampled_held[row])
    {
        seen_.resize(levels, 0.0), kept_.resize(levels, 0.0);
    }
    /// The cheapest level of a component that keeps the bound, and the cheapest one that was tried: below it nothing is known. What a level
    /// keeps, finer ones keep too; what it breaks, cheaper ones break too.
    void add(std::int32_t cheapest, std::int32_t tried)
    {
        constexpr double kMemory = 64;
        for (std::size_t l = 0; l < seen_.size(); ++l)
        {
            const auto level = static_cast<std::int32_t>(l);
            if (level < cheapest && tried == cheapest) continue;
            seen_[l] += 1 - seen_[l] / kMemory;
            kept_[l] += (level >= cheapest ? 1 : 0) - kept_[l] / kMemory;
        }
    }
    /// The cheapest level that the bound is kept with in a share of `target` at least.
    std::int32_t level(double target) const
    {
        std::size_t l = 0;
        while (l + 1 < seen_.size() && (kept_[l] + 1) / (seen_[l] + 2) < target) ++l;
        return static_cast<std::int32_t>(l);
    }

private:
    Reals &seen_, &kept_;
};

/// Rule of succession (Laplace): nothing is certain after no or few trials.
double confidence_of(std::int64_t held, std::int64_t judged) { return static_cast<double>(held + 1) / static_cast<double>(judged + 2); }

/// Of types that answer contacts: an impact does not announce itself, so what was measured holds for the interval of the measurement only.
bool answers_contacts(const std::string& ladder)
{
    constexpr std::string_view kKinds[] = {"CDetection", "Manager", "Resolution", "Response"};
    return std::any_of(std::begin(kKinds), std::end(kKinds), [&](std::string_view kind) { return ladder.starts_with(kind); });
}

/// Of a trial, as Simulation makes them (error_of_level): of a solver a quarter of the interval, but eight steps at least.
double steps_of_trial(const StepContext& context, Row row, const ErrorRows& governors)
{
    constexpr double kMost = 256, kFewest = 8;
    const double whole = std::max(1.0, std::round(governors.interval[row] / context.dt));
    const bool goes_on = governors.watch.levels[row].starts_with("Solver");
    return std::min(kMost, goes_on ? std::min(whole, std::max(kFewest, std::ceil(whole / 4))) : whole);
}

/// Promises that were judged in one look, and those of them that were broken.
struct Judged
{
    std::size_t all = 0, broken = 0;

    /// Three standard deviations more than may be, if each were broken by itself: something has come over all of them.
    bool is_burst(double target) const
    {
        const double n = static_cast<double>(all), chance = n * (1 - target);
        return broken > 1 && static_cast<double>(broken) > chance + 3 * std::sqrt(chance * target);
    }
};

/// Learns from the promises of a look. A burst tells no more than one broken promise does.
void learn(const Judged& judged, Row row, ErrorRows& governors)
{
    constexpr double kGain = 0.25, kMost = 1e4;
    constexpr double kSooner = 0.5, kLater = 1.02, kLongest = 16;
    const double c = governors.target[row];
    const bool burst = judged.is_burst(c);
    const double broken = burst ? 1 : static_cast<double>(judged.broken), held = static_cast<double>(judged.all - judged.broken);
    governors.judged[row] += static_cast<std::int64_t>(judged.all);
    governors.held[row] += static_cast<std::int64_t>(judged.all - judged.broken);
    governors.safety[row] = std::clamp(governors.safety[row] * std::exp(kGain * (c * broken - (1 - c) * held)), 1.0, kMost);
    governors.patience[row] = std::clamp(governors.patience[row] * std::pow(kLater, held) * std::pow(kSooner, broken), 1.0, kLongest);
}

/// Measures a component, chooses its level, and says when it is measured again. `sample`: null if each component is measured.
void measure(const StepContext& context, Row row, std::size_t k, double scale, Look& look, ErrorRows& governors, LevelControl& control,
             Sample* sample, Judged& judged)
{
    const GovernedComponent& g = look.watched()[k];
    const std::string_view id = control.id_of(g.component);
    const double bound = governors.bound[row], every = governors.watch.every[row], reserve = governors.watch.hysteresis[row];
    Entries& next = governors.next[row];
    auto entry = place_of(next, id);
    const bool known = g.level >= 0 && (sample || (entry != next.end() && entry->name == id));
    Measurement of(row, k, scale, governors, control);
    std::int32_t level = known ? g.level : 0, tried = level;
    double error = of.at(level, known ? bound : of.most());
    if (known && level < look.finest()) ++judged.all, judged.broken += error <= bound ? 0u : 1u;
    bool finer = false;
    double excess = 1;  // of the error of the next cheaper level, as a multiple of what is allowed
    for (; level < look.finest() && !of.fits(error); finer = true) excess = error / of.most(), error = of.at(++level, of.most());
    if (known && !finer && level > 0 && (sample || look.rested(k)))
    {
        const double cheaper = of.at(tried = level - 1, of.most(reserve));
        excess = cheaper / of.most(reserve);
        if (of.fits(cheaper, reserve)) --level, error = cheaper;
    }
    if (sample)
    {
        sample->add(level, tried);
        governors.allowance[row] -= static_cast<double>(of.tried() + 1) * steps_of_trial(context, row, governors);
        if (const std::int32_t least = sample->level(governors.target[row]); least > level) error = of.at(level = least);
    }
    const bool waits = level < g.level && !look.rested(k);
    if (waits) level = g.level, error = of.at(level);
    if (look.may_choose(k, level))
        (void)look.choose(k, level,
                          "error " + brief(error) + " of " + brief(bound) + " " + governors.unit[row] + " in " +
                              brief(governors.interval[row]) + " s, confidence " + brief(governors.confidence[row]));
    if (!std::isnan(error)) governors.worst[row] = std::max(governors.worst[row], error);
    // Far below the bound it is measured less often.
    const double likely = error * governors.safety[row];
    const double longest = answers_contacts(governors.watch.levels[row]) ? 1.0 : governors.patience[row];
    double longer = likely > 0 ? std::clamp(std::sqrt(bound / likely), 1.0, longest) : std::isnan(likely) ? 1 : longest;
    if (level == look.finest()) longer = std::max(longer, kIdle * std::clamp(std::sqrt(excess), 1.0, kSeldom));
    const double then = context.time + every * (waits ? 1 : longer);
    entry = place_of(next, id);
    if (entry != next.end() && entry->name == id)
        entry->value = then;
    else
        next.insert(entry, {std::string(id), then});
    control.tell(row, k, error, governors.unit[row], then);
}

/// Nobody can see how wrong it is.
void leave_unseen(Row row, std::size_t k, Look& look, ErrorRows& governors, LevelControl& control)
{
    Entries& next = governors.next[row];
    const std::string_view id = control.id_of(look.watched()[k].component);
    if (const auto entry = place_of(next, id); entry != next.end() && entry->name == id) next.erase(entry);
    if (look.may_choose(k, 0)) (void)look.choose(k, 0, "out of every viewer's sight");
}

/// s, from one look to the next: what happens in a time for which nobody looks would break promises unseen.
double period_of(Row row, const ErrorRows& governors) { return std::min(governors.watch.every[row], governors.interval[row]); }

/// What is not spent until the next look but one is lost.
void allow_trials(const StepContext& context, Row row, const Look& look, ErrorRows& governors)
{
    const double steps = std::max(1.0, period_of(row, governors) / context.dt);
    const double more = governors.share[row] * steps * static_cast<double>(look.watched().size());
    governors.allowance[row] = std::min(governors.allowance[row] + more, 2 * more);
}

/// What is not in the sample.
void follow_sample(Row row, std::size_t k, const Sample& sample, Look& look, const ErrorRows& governors)
{
    const double target = governors.target[row], surer = 1 - (1 - target) * (1 - governors.watch.hysteresis[row]);
    const std::int32_t now = look.watched()[k].level, least = sample.level(target), level = now < least ? least : sample.level(surer);
    if ((now < least || now > level) && look.may_choose(k, level))
        (void)look.choose(k, level, "a sample of the others keeps " + brief(governors.bound[row]) + " " + governors.unit[row] + " with it");
}

const char* why_unmeasured(bool known, bool by_sight)
{
    if (known) return "its error has not been measured for too long";
    return by_sight ? "it comes into view, and its error has not been measured yet" : "its error has not been measured yet";
}

/// Those that are measured next: when (s), or -1 if they have not been measured yet; and their place in the look.
using Due = std::vector<std::pair<double, std::size_t>>;

/// Puts those first that are measured in this look, and returns how many that are. Those come first that have waited longest; but half of
/// the measurements are for promises, if there are so many: until one is judged nothing is known of any of them. Some promises are judged
/// before they are due if there are not enough: what happens to all at the same time must not happen between two looks.
std::size_t put_in_order(Due& waiting, std::size_t most, double now)
{
    std::sort(waiting.begin(), waiting.end());
    const auto promised = std::find_if(waiting.begin(), waiting.end(), [](const auto& w) { return w.first >= 0; });
    const auto later = std::find_if(promised, waiting.end(), [&](const auto& w) { return w.first > now; });
    const auto probes = static_cast<std::ptrdiff_t>(most / 8);
    const auto judged = std::min(static_cast<std::ptrdiff_t>(most / 2), later - promised);
    const auto first = std::min(std::max(judged, probes), waiting.end() - promised);
    const auto due = static_cast<std::size_t>(std::max(later - waiting.begin(), promised - waiting.begin() + first));
    std::rotate(waiting.begin(), promised, promised + first);
    return std::min(due, most);
}

/// One look of a governor by error.
class ErrorLook
{
public:
    ErrorLook(const StepContext& context, Row row, ErrorRows& governors, LevelControl& control)
        : context_(context),
          row_(row),
          g_(governors),
          control_(control),
          look_(context, row, governors.watch, control),
          now_(context.time + 1e-9 * std::max(1.0, context.time)),
          by_sight_(governors.unit[row] == "pixels"),
          samples_(governors.share[row] > 0 && !by_sight_),
          sample_(row, governors, samples_ ? static_cast<std::size_t>(look_.finest() + 1) : 0)
    {
    }
    void run();

private:
    Due those_in_sight();
    void pass_over(const std::pair<double, std::size_t>& waits);
    void doubt_all(const Due& waiting, std::size_t from);
    double scale_of(std::size_t k) const
    {
        return by_sight_ ? pixels_per_metre(look_.watched()[k], control_.viewpoints(), g_.look_ahead[row_], g_.margin[row_]) : 1.0;
    }

    const StepContext& context_;
    Row row_;
    ErrorRows& g_;
    LevelControl& control_;
    Look look_;
    double now_;
    bool by_sight_, samples_;
    Sample sample_;
};

Due ErrorLook::those_in_sight()
{
    Due out;
    for (std::size_t k = 0; k < look_.watched().size(); ++k)
    {
        if (scale_of(k) == kHidden)
        {
            leave_unseen(row_, k, look_, g_, control_);
            continue;
        }
        const std::string_view id = control_.id_of(look_.watched()[k].component);
        const auto entry = place_of(g_.next[row_], id);
        const bool known = entry != g_.next[row_].end() && entry->name == id;
        out.emplace_back(known ? std::get<double>(entry->value) : -1, k);
    }
    return out;
}

/// What is not measured in this look.
void ErrorLook::pass_over(const std::pair<double, std::size_t>& waits)
{
    const auto [at, k] = waits;
    if (at > now_) return;
    if (samples_) return follow_sample(row_, k, sample_, look_, g_);
    const bool too_long = at < 0 || at < context_.time - 2 * g_.watch.every[row_];
    if (too_long && look_.may_choose(k, look_.finest())) (void)look_.choose(k, look_.finest(), why_unmeasured(at >= 0, by_sight_));
}

/// Promises of many were broken at the same time, so none of the others is trusted until it is measured again.
void ErrorLook::doubt_all(const Due& waiting, std::size_t from)
{
    for (std::size_t n = from; n < waiting.size(); ++n)
    {
        const std::size_t k = waiting[n].second;
        // One after the other, so that not all are measured at the same look.
        const double part = static_cast<double>(n - from + 1) / static_cast<double>(waiting.size() - from);
        const double again = context_.time + kIdle * part * g_.watch.every[row_];
        const std::string_view id = control_.id_of(look_.watched()[k].component);
        if (const auto entry = place_of(g_.next[row_], id); entry != g_.next[row_].end() && entry->name == id) entry->value = again;
        if (look_.may_choose(k, look_.finest())) (void)look_.choose(k, look_.finest(), "the promises of many others have just been broken");
    }
}

void ErrorLook::run()
{
    g_.confidence[row_] = confidence_of(g_.held[row_], g_.judged[row_]);
    Due waiting = those_in_sight();
    if (waiting.empty()) return;
    const std::size_t measured = put_in_order(waiting, static_cast<std::size_t>(g_.looks[row_]), now_);
    if (measured > 0) g_.worst[row_] = 0;
    if (samples_) allow_trials(context_, row_, look_, g_);
    Judged judged;
    for (std::size_t n = 0; n < waiting.size(); ++n)
    {
        const std::size_t k = waiting[n].second;
        if (n < measured && (!samples_ || g_.allowance[row_] > 0))
            measure(context_, row_, k, scale_of(k), look_, g_, control_, samples_ ? &sample_ : nullptr, judged);
        else
            pass_over(waiting[n]);
    }
    learn(judged, row_, g_);
    if (!samples_ && judged.is_burst(g_.target[row_])) doubt_all(waiting, measured);
}

}  // namespace

void keep_error(const StepContext& context, Row row, ErrorRows& governors, LevelControl& control)
{
    if (due(context, period_of(row, governors))) ErrorLook(context, row, governors, control).run();
}

}  // namespace plab::governors
