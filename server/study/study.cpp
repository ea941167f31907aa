#include "study/study.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "model/names.h"
#include "model/numbers.h"
#include "model/text.h"

namespace plab::study
{
namespace
{

constexpr std::int64_t kMostSamples = 1000;
/// Larger mixed errors are not meaningful: the run blew up.
constexpr double kBlownUp = 1e3;

/// Rank of a type in its ladder: by order first, then by what it certifies and locates.
int height_of(model::TypeSource& types, const std::string& name)
{
    const auto type = types.require(name);
    if (!type) return -1;
    const TypeInfo& info = (*type)->info;
    return 100 * info.order + 4 * info.certifies + 2 * info.locates + info.local;
}

class Run
{
public:
    Run(model::TypeSource& types, const Plan& plan) : types_(types), plan_(plan), options_(plan.run), planned_(plan.swaps) {}
    Result<StudyResult> go();
    Result<void> check_swaps();

private:
    /// The algorithm of the reference `auto`; its scene has the longest of the three step lengths.
    struct AutoAlgorithm
    {
        std::string name;
        model::SceneSpec scene;
    };

    void apply_settings();
    Result<void> prepare();
    Result<void> choose_samples();
    Result<void> choose_swaps();
    Result<void> choose_quantities();
    Result<void> check_scales() const;
    Result<void> make_reference();
    Result<AutoAlgorithm> auto_algorithm() const;
    Result<void> make_auto();
    const Combination& finest() const;
    Result<void> record_all();
    Result<void> time_all();
    RunOptions options_of(std::size_t run) const;
    RunOptions timed_part(std::size_t run) const;
    void judge(Point& point);
    void report_progress(const std::string& what, double share);
    Result<void> go_on(const std::string& what) const;

    model::TypeSource& types_;
    const Plan& plan_;
    RunOptions options_;
    std::vector<PlannedSwap> planned_;
    std::vector<Result<model::SceneSpec>> scenes_;
    std::vector<std::vector<SwapAt>> swaps_;  // of each run
    StudyResult out_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

void Run::report_progress(const std::string& what, double share)
{
    if (!plan_.progress) return;
    const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    char text[64] = "";
    if (share > 0.02 && passed > 1) std::snprintf(text, sizeof text, ", about %.0f s left", std::ceil(passed / share * (1 - share)));
    plan_.progress(what + text);
}

/// An error if the study was interrupted: a partial study has no result.
Result<void> Run::go_on(const std::string& what) const
{
    if (!plan_.run.is_stopped()) return {};
    return reason("interrupted while " + what + "; no result of this study is written");
}

void Run::apply_settings()
{
    for (const Combination& c : plan_.combinations) scenes_.push_back(apply(plan_.scene, types_, c.settings));
    swaps_.resize(scenes_.size());
}

Result<void> Run::prepare()
{
    if (plan_.combinations.empty()) return reason("there is no combination to study");
    if (!(plan_.run.until > 0)) return reason("--until must be positive");
    apply_settings();
    if (auto chosen = choose_samples(); !chosen) return chosen;
    if (auto chosen = choose_swaps(); !chosen) return chosen;
    return choose_quantities();
}

/// Swaps that are not possible in any run are an error; a single run in which they are not possible is refused, as with a
/// setting.
Result<void> Run::choose_swaps()
{
    if (planned_.empty()) return {};
    std::vector<model::StepLength> lengths;
    for (const auto& scene : scenes_)
        if (scene) lengths.push_back(scene->settings.dt);
    if (auto settled = settle_times(planned_, lengths, options_.until); !settled) return settled;
    bool any = false;
    Errors why;
    for (std::size_t i = 0; i < scenes_.size(); ++i)
    {
        if (!scenes_[i]) continue;
        auto swaps = swaps_of(planned_, *scenes_[i], types_);
        any = any || swaps;
        if (swaps)
            swaps_[i] = swaps.take();
        else
            why = swaps.errors(), scenes_[i] = why;
    }
    return any ? Result<void>() : why;
}

/// go() reports errors in the rest of the plan.
Result<void> Run::check_swaps()
{
    if (planned_.empty() || plan_.combinations.empty() || !(plan_.run.until > 0)) return {};
    apply_settings();
    if (!choose_samples()) return {};
    if (auto chosen = choose_swaps(); !chosen) return chosen;
    if (plan_.reference.kind != ReferencePlan::Kind::Auto) return {};
    const auto algorithm = auto_algorithm();
    if (!algorithm) return {};
    const auto swaps = swaps_of(planned_, algorithm->scene, types_);
    return swaps ? Result<void>() : reason("in the reference: " + swaps.error().reason);
}

/// Instants that all step lengths share, at most kMostSamples of them, from the start to the last one.
Result<void> Run::choose_samples()
{
    std::vector<model::StepLength> lengths;
    for (const auto& scene : scenes_)
        if (scene) lengths.push_back(scene->settings.dt);
    if (lengths.empty()) return scenes_.front().errors();
    const auto common = common_instants(lengths);
    if (!common) return common.errors();
    const auto last = static_cast<std::int64_t>(std::floor(plan_.run.until / common->seconds * (1 + 1e-12) + 1e-9));
    if (last < 1)
        return reason("the step lengths meet for the first time at t = " + model::format_real(common->seconds) +
                      " s, after --until: choose lengths that divide one another, or a later end");
    const std::int64_t stride = (last + kMostSamples - 1) / kMostSamples;
    for (std::int64_t n = last % stride; n <= last; n += stride) options_.sample_times.push_back(common->at(n));
    if (options_.sample_times.front() > 0) options_.sample_times.insert(options_.sample_times.begin(), 0.0);
    out_.until = options_.until = options_.sample_times.back();
    if (std::fabs(out_.until - plan_.run.until) > 1e-9 * plan_.run.until)
        out_.notes.push_back("Compared up to t = " + model::format_real(out_.until) + " s, the last instant that all step lengths share.");
    return {};
}

Result<void> Run::choose_quantities()
{
    for (const auto& scene : scenes_)
    {
        simulation::Simulation s(types_, 1);
        if (!scene || !s.load(*scene)) continue;
        if (options_.quantities.empty()) options_.quantities = default_quantities(s.world());
        if (options_.quantities.empty()) return reason("nothing moves in the scene: name a quantity with --quantity ID.field");
        for (const std::string& text : options_.quantities)
        {
            auto q = resolve_quantity(s.world(), text);
            if (!q) return q.errors();
            out_.quantities.push_back(q.take());
        }
        return check_scales();
    }
    // No scene loads: each combination has its own reason.
    return {};
}

Result<void> Run::check_scales() const
{
    for (const auto& [name, scale] : plan_.scales)
        if (std::find(options_.quantities.begin(), options_.quantities.end(), name) == options_.quantities.end())
            return reason("--scale " + name + ": no quantity of that name is compared" + model::did_you_mean(name, options_.quantities) +
                          "; compared are " + model::quoted_list(options_.quantities));
    return {};
}

const Combination& Run::finest() const
{
    // In order: the highest types, then the shortest step, then the last in the list.
    const Combination* best = nullptr;
    std::pair<int, double> best_rank;
    for (std::size_t i = 0; i < scenes_.size(); ++i)
    {
        if (!scenes_[i]) continue;
        int height = 0;
        for (const Setting& s : plan_.combinations[i].settings)
            if (const auto* c = scenes_[i]->find(s.target)) height += height_of(types_, c->type);
        const std::pair<int, double> rank{height, -scenes_[i]->settings.dt.seconds};
        if (!best || rank >= best_rank) best = &plan_.combinations[i], best_rank = rank;
    }
    return *best;
}

Result<Run::AutoAlgorithm> Run::auto_algorithm() const
{
    Combination chosen = finest();
    double shortest = std::numeric_limits<double>::infinity();
    model::StepLength dt;
    for (const auto& scene : scenes_)
        if (scene && scene->settings.dt.seconds < shortest) dt = scene->settings.dt, shortest = dt.seconds;
    if (plan_.reference.algorithm) chosen = combine({*plan_.reference.algorithm}, {}).front();
    auto scene = apply(plan_.scene, types_, chosen.settings);
    if (!scene) return scene.errors();
    if (!plan_.reference.algorithm || chosen.dt.empty()) scene->settings.dt = dt;
    return AutoAlgorithm{chosen.algorithm, scene.take()};
}

Result<void> Run::make_auto()
{
    auto algorithm = auto_algorithm();
    if (!algorithm) return algorithm.errors();
    const model::StepLength dt = algorithm->scene.settings.dt;
    RunOptions options = options_;
    options.budget = 20 * options_.budget;
    std::vector<RunRecord> runs;
    for (int i = 0; i < 3; ++i)
    {
        model::StepLength& part = algorithm->scene.settings.dt;
        part = dt, part.denominator = dt.denominator << i, part.seconds = dt.seconds / (1 << i);
        auto swaps = swaps_of(planned_, algorithm->scene, types_);
        if (!swaps) return reason("in the reference: " + swaps.error().reason);
        options.swaps = swaps.take();
        report_progress("reference " + std::to_string(i + 1) + " of 3: " + algorithm->name, 0);
        runs.push_back(record_run(types_, algorithm->scene, options));
        if (auto on = go_on("making the reference, run " + std::to_string(i + 1) + " of 3"); !on) return on;
    }
    out_.reference = auto_reference(runs, algorithm->name, model::format_real(dt.seconds));
    return {};
}

Result<void> Run::make_reference()
{
    const std::size_t n = out_.quantities.size();
    switch (plan_.reference.kind)
    {
        case ReferencePlan::Kind::None:
            out_.reference = no_reference(n, "none was asked for");
            break;
        case ReferencePlan::Kind::Exact:
        {
            const auto scene = std::find_if(scenes_.begin(), scenes_.end(), [](const auto& s) { return s.ok(); });
            auto made = exact_reference(types_, **scene, options_, plan_.reference.text);
            if (!made) return made.errors();
            out_.reference = made.take();
            break;
        }
        case ReferencePlan::Kind::File:
        {
            auto made = file_reference(out_.quantities, options_.sample_times, plan_.reference.text);
            if (!made) return made.errors();
            out_.reference = made.take();
            break;
        }
        case ReferencePlan::Kind::Auto:
            if (auto made = make_auto(); !made) return made;
    }
    for (std::size_t k = 0; k < n; ++k)
        if (const auto given = plan_.scales.find(out_.quantities[k].name); given != plan_.scales.end())
            out_.reference.scale[k] = given->second;
    return {};
}

/// The first run of each combination warms up the machine, and is the one that is recorded.
Result<void> Run::record_all()
{
    const double runs = static_cast<double>(scenes_.size() * (static_cast<std::size_t>(plan_.repeat) + 1));
    for (std::size_t i = 0; i < scenes_.size(); ++i)
    {
        Point point;
        point.combination = plan_.combinations[i];
        report_progress("recording " + std::to_string(i + 1) + " of " + std::to_string(scenes_.size()) + ": " + point.combination.label(),
                        static_cast<double>(i) / runs);
        if (scenes_[i])
            point.record = record_run(types_, *scenes_[i], options_of(i));
        else
            point.record.outcome = Outcome::Refused, point.record.why = scenes_[i].error().text();
        out_.points.push_back(std::move(point));
        if (auto on = go_on("recording run " + std::to_string(i + 1) + " of " + std::to_string(scenes_.size())); !on) return on;
    }
    return {};
}

RunOptions Run::options_of(std::size_t run) const
{
    RunOptions out = options_;
    out.swaps = swaps_[run];
    return out;
}

/// A failed run is timed up to its failure.
RunOptions Run::timed_part(std::size_t run) const
{
    RunOptions out = options_of(run);
    const RunRecord& record = out_.points[run].record;
    if (!record.ok()) out.sample_times = {std::max(record.reached, record.dt)};
    return out;
}

Result<void> Run::time_all()
{
    const std::size_t n = scenes_.size();
    std::vector<std::vector<double>> seconds(n);
    for (int r = 0; r < plan_.repeat; ++r)
        for (std::size_t k = 0; k < n; ++k)
        {
            // Rotated, so that no run always follows the same neighbour.
            const std::size_t i = (k + static_cast<std::size_t>(r)) % n;
            Point& point = out_.points[i];
            if (point.record.outcome == Outcome::Refused || point.record.outcome == Outcome::TooSlow) continue;
            report_progress(
                "timing, round " + std::to_string(r + 1) + " of " + std::to_string(plan_.repeat) + ": " + point.combination.label(),
                static_cast<double>(n + static_cast<std::size_t>(r) * n + k) /
                    static_cast<double>(n * (static_cast<std::size_t>(plan_.repeat) + 1)));
            const Timing t = time_run(types_, *scenes_[i], timed_part(i));
            if (auto on = go_on("timing, round " + std::to_string(r + 1) + " of " + std::to_string(plan_.repeat)); !on) return on;
            if (t.outcome == Outcome::Completed || t.outcome == point.record.outcome) seconds[i].push_back(t.cpu);
        }
    for (std::size_t i = 0; i < n; ++i)
    {
        std::vector<double>& s = seconds[i];
        Point& point = out_.points[i];
        std::sort(s.begin(), s.end());
        point.timed = static_cast<int>(s.size());
        point.cpu_min = s.empty() ? kNaN : s.front();
        point.cpu_median = s.empty() ? kNaN : s.size() % 2 == 1 ? s[s.size() / 2] : 0.5 * (s[s.size() / 2 - 1] + s[s.size() / 2]);
    }
    return {};
}

void Run::judge(Point& point)
{
    const RunRecord& record = point.record;
    const Reference& reference = out_.reference;
    for (std::size_t k = 0; k < out_.quantities.size(); ++k)
    {
        const bool known = reference.kind != "none" && k < record.time_series.size();
        Distance e{kNaN, kNaN, kNaN, kNaN};
        if (known) e = distance(out_.quantities[k], record.time_series[k], reference.time_series[k], reference.scale[k]);
        if (!record.ok()) e.last = e.last_absolute = kNaN;
        point.errors.push_back(e);
        point.resolved.push_back(!(e.series <= reference.uncertainty[k].series));
    }
    if (record.ok() && point.error() > kBlownUp)
    {
        point.record.outcome = Outcome::BlewUp;
        point.record.why = "it moved " + model::format_real(std::round(point.error())) + " times as far from the reference as that goes";
    }
    double drift = 0;
    for (const double d : record.energy.drift) drift = std::fabs(d) > drift || std::isnan(d) ? std::fabs(d) : drift;
    // If nothing moves, a millionth of the magnitude is used as the scale.
    double scale = record.energy.scale;
    for (const double e : record.energy.energy) scale = std::max(scale, 1e-6 * std::fabs(e));
    point.energy_drift = scale > 0 ? drift / scale : drift;
    if (reference.knows_contacts && record.ok()) point.contacts = compare_contacts(record.contacts, reference.contacts);
}

Result<StudyResult> Run::go()
{
    if (auto fine = prepare(); !fine) return fine.errors();
    if (auto made = make_reference(); !made) return made.errors();
    if (auto recorded = record_all(); !recorded) return recorded.errors();
    if (auto timed = time_all(); !timed) return timed.errors();
    for (Point& point : out_.points) judge(point);
    out_.title = plan_.title.empty() ? (plan_.scene.settings.title.empty() ? plan_.scene.file : plan_.scene.settings.title) : plan_.title;
    out_.scene_file = plan_.scene.file, out_.command = plan_.command, out_.repeat = plan_.repeat;
    out_.machine = describe_machine();
    out_.swaps = !planned_.empty();
    return std::move(out_);
}

}  // namespace

Result<void> check_swaps(model::TypeSource& types, const Plan& plan) { return Run(types, plan).check_swaps(); }

Result<StudyResult> run_study(model::TypeSource& types, const Plan& plan) { return Run(types, plan).go(); }

}  // namespace plab::study
