#include "by_error.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "sight.h"

namespace plab::governors
{
namespace
{

constexpr double kHidden = 0;

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
    /// In the governor's unit. NaN: it cannot be told.
    double at(std::int32_t level)
    {
        const double e = pick(control_.error(row_, index_, level, governors_.interval[row_]), governors_.unit[row_], scale_);
        ++governors_.measured[row_], ++tried_;
        governors_.unknown[row_] += std::isnan(e) ? 1 : 0;
        return e;
    }
    /// How many levels were tried, each beside the next finer one.
    std::size_t tried() const { return tried_; }
    /// What cannot be told is taken for too much.
    bool fits(double error, double reserve = 0) const { return error * governors_.safety[row_] * (1 + reserve) <= governors_.bound[row_]; }

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

void judge(bool held, Row row, ErrorRows& governors)
{
    constexpr double kGain = 0.25, kMost = 1e4;
    constexpr double kSooner = 0.5, kLater = 1.02, kLongest = 16;
    const double c = governors.target[row];
    ++governors.judged[row], governors.held[row] += held ? 1 : 0;
    governors.safety[row] = std::clamp(governors.safety[row] * std::exp(kGain * (held ? c - 1 : c)), 1.0, kMost);
    governors.patience[row] = std::clamp(governors.patience[row] * (held ? kLater : kSooner), 1.0, kLongest);
}

/// Rule of succession (Laplace): nothing is certain after no or few trials.
double confidence_of(std::int64_t held, std::int64_t judged) { return static_cast<double>(held + 1) / static_cast<double>(judged + 2); }

/// Of types that answer contacts: an impact does not announce itself, so what was measured holds for the interval of the measurement only.
bool answers_contacts(const std::string& ladder)
{
    constexpr std::string_view kKinds[] = {"CDetection", "Manager", "Resolution", "Response"};
    return std::any_of(std::begin(kKinds), std::end(kKinds), [&](std::string_view kind) { return ladder.starts_with(kind); });
}

/// Of a trial, as Simulation makes them: of a solver a quarter of the interval.
double steps_of_trial(const StepContext& context, Row row, const ErrorRows& governors)
{
    const double whole = std::max(1.0, governors.interval[row] / context.dt);
    return governors.watch.levels[row].starts_with("Solver") ? std::ceil(whole / 4) : whole;
}

/// Measures a component, chooses its level, and says when it is measured again. `sample`: null if each component is measured.
void measure(const StepContext& context, Row row, std::size_t k, double scale, Look& look, ErrorRows& governors, LevelControl& control,
             Sample* sample)
{
    const GovernedComponent& g = look.watched()[k];
    const std::string_view id = control.id_of(g.component);
    const double bound = governors.bound[row], every = governors.watch.every[row];
    Entries& next = governors.next[row];
    auto entry = place_of(next, id);
    const bool known = g.level >= 0 && (sample || (entry != next.end() && entry->name == id));
    Measurement of(row, k, scale, governors, control);
    std::int32_t level = known ? g.level : 0, tried = level;
    double error = of.at(level);
    if (known && level < look.finest()) judge(error <= bound, row, governors);
    bool finer = false;
    for (; level < look.finest() && !of.fits(error); finer = true) error = of.at(++level);
    if (known && !finer && level > 0 && (sample || look.rested(k)))
        if (const double cheaper = of.at(tried = level - 1); of.fits(cheaper, governors.watch.hysteresis[row])) --level, error = cheaper;
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
    const double longer = likely > 0 ? std::clamp(std::sqrt(bound / likely), 1.0, longest) : std::isnan(likely) ? 1 : longest;
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

/// What is not spent until the next look but one is lost.
void allow_trials(const StepContext& context, Row row, const Look& look, ErrorRows& governors)
{
    const double steps = std::max(1.0, governors.watch.every[row] / context.dt);
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

/// Those that are due: when (s), or -1 if they have not been measured yet; and their place in the look.
using Due = std::vector<std::pair<double, std::size_t>>;

/// Those first that have waited longest; but half of the measurements are for promises that are due, if there are so many: until one is
/// judged nothing is known of any of them.
void put_in_order(Due& waiting, std::size_t measurements)
{
    std::sort(waiting.begin(), waiting.end());
    const auto promised = std::find_if(waiting.begin(), waiting.end(), [](const auto& w) { return w.first >= 0; });
    const auto judged = std::min(static_cast<std::ptrdiff_t>(measurements / 2), waiting.end() - promised);
    std::rotate(waiting.begin(), promised, promised + judged);
}

}  // namespace

void ErrorRows::describe(Schema& schema)
{
    watch.describe(schema);
    schema.param(bound, "bound", unit::one, "error that is allowed within `interval`, against the next finer level, in the unit `unit`")
        .positive();
    schema
        .param(unit, "unit", unit::one,
               "`m`: a point of a body; `rad`: a body or a shaft; `W`: energy made or lost in a second; `pixels`: as viewers see it")
        .or_else("m")
        .one_of({"m", "rad", "W", "pixels"});
    schema.param(interval, "interval", unit::second, "time within which the error is counted").or_else(0.25).positive();
    schema.param(target, "target", unit::one, "share of the measurements that shall find the error still below the bound")
        .or_else(0.95)
        .at_least(0.5)
        .at_most(0.999);
    schema.param(looks, "looks", unit::one, "components that are measured at most in one look").or_else(8).positive();
    schema
        .param(share, "share", unit::one,
               "trial steps at most for each step of the watched components: only a sample of them is measured, and all get the level with "
               "which a share `target` of the sample keeps the bound; 0: no limit; not used with `pixels`")
        .or_else(0)
        .not_negative();
    schema.param(look_ahead, "look_ahead", unit::second, "of `pixels`: what may come into view within this time counts as seen")
        .or_else(0.5)
        .not_negative();
    schema.param(margin, "margin", unit::radian, "of `pixels`: what is outside of the picture by less than this angle counts as seen")
        .or_else(0.15)
        .not_negative();
    schema.state(next, "next", unit::one, "when a component is measured again, s");
    schema.state(safety, "safety", unit::one, "factor by which measured errors are taken to be larger").initially(2);
    schema
        .state(patience, "patience", unit::one,
               "times `every` after which what is far below the bound is measured again; it falls with each promise that is broken")
        .initially(3);
    schema.state(judged, "judged", unit::one, "measurements of a level that was measured before");
    schema.state(held, "held", unit::one, "those of them that found the error still below the bound");
    schema.state(allowance, "allowance", unit::one, "trial steps that may be made within `share`");
    schema.state(sampled, "sampled", unit::one, "with `share`: components that were sampled, by level; older ones fade");
    schema.state(sampled_held, "sampled_held", unit::one, "those of them whose error was below the bound");
    schema.output(confidence, "confidence", unit::one, "with which a level's error is below the bound when it is measured again");
    schema.output(worst, "worst", unit::one,
                  "the largest error of the last look in which something was measured, of the levels that were kept");
    schema.output(measured, "measured", unit::one, "number of errors that were measured");
    schema.output(unknown, "unknown", unit::one, "number of those that could not be told");
}

void keep_error(const StepContext& context, Row row, ErrorRows& governors, LevelControl& control)
{
    if (!due(context, governors.watch.every[row])) return;
    Look look(context, row, governors.watch, control);
    governors.confidence[row] = confidence_of(governors.held[row], governors.judged[row]);
    const bool by_sight = governors.unit[row] == "pixels";
    Due waiting;
    const auto scale_of = [&](std::size_t k) {
        return by_sight ? pixels_per_metre(look.watched()[k], control.viewpoints(), governors.look_ahead[row], governors.margin[row]) : 1.0;
    };
    for (std::size_t k = 0; k < look.watched().size(); ++k)
    {
        const std::string_view id = control.id_of(look.watched()[k].component);
        if (scale_of(k) == kHidden)
        {
            leave_unseen(row, k, look, governors, control);
            continue;
        }
        const auto entry = place_of(governors.next[row], id);
        const bool known = entry != governors.next[row].end() && entry->name == id;
        const double at = known ? std::get<double>(entry->value) : 0;
        if (at <= context.time + 1e-9 * std::max(1.0, context.time)) waiting.emplace_back(known ? at : -1, k);
    }
    if (waiting.empty()) return;
    governors.worst[row] = 0;
    const auto most = static_cast<std::size_t>(governors.looks[row]);
    put_in_order(waiting, most);
    const bool samples = governors.share[row] > 0 && !by_sight;
    Sample sample(row, governors, samples ? static_cast<std::size_t>(look.finest() + 1) : 0);
    if (samples) allow_trials(context, row, look, governors);
    for (std::size_t n = 0; n < waiting.size(); ++n)
    {
        const std::size_t k = waiting[n].second;
        if (n < most && (!samples || governors.allowance[row] > 0))
            measure(context, row, k, scale_of(k), look, governors, control, samples ? &sample : nullptr);
        else if (samples)
            follow_sample(row, k, sample, look, governors);
        else if ((waiting[n].first < 0 || waiting[n].first < context.time - 2 * governors.watch.every[row]) &&
                 look.may_choose(k, look.finest()))
            (void)look.choose(k, look.finest(), why_unmeasured(waiting[n].first >= 0, by_sight));
    }
}

}  // namespace plab::governors
