#include "study/govern.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "simulation/simulation.h"
#include "study/run.h"
#include "study/shadow.h"

namespace plab::study
{
namespace
{

using simulation::LevelInfo;
using simulation::Simulation;

std::string level_of_body(const Simulation& run, Ref body)
{
    for (const LevelInfo& l : run.levels().levels())
        for (const Ref object : run.levels().objects_of(l.component))
            if (object == body) return l.text;
    return {};
}

/// Sums of squares until take_mean() is called.
void add_errors(Simulation& run, const Simulation& reference, const std::vector<ObjectPair>& objects, GovernError& out)
{
    const std::vector<Viewpoint> eyes = run.viewpoints();
    for (const ObjectPair& p : objects)
    {
        const double metres = apart(run, reference, p).metres;
        out.metres += metres * metres, ++out.bodies;
        const double scale = pixels_per_metre(eyes, run.world().host().bodies.position[p.here]);
        if (scale == 0) continue;
        const double pixels = metres * scale;
        out.pixels += pixels * pixels, ++out.seen;
        if (pixels <= out.worst_pixels) continue;
        const Ref body{Facet::Body, p.here};
        out.worst_pixels = pixels, out.worst = run.world().id_of(body), out.worst_at = run.time();
        out.worst_level = level_of_body(run, body);
    }
}

void take_mean(GovernError& e)
{
    e.pixels = std::sqrt(e.pixels / static_cast<double>(std::max<std::size_t>(1, e.seen)));
    e.metres = std::sqrt(e.metres / static_cast<double>(std::max<std::size_t>(1, e.bodies)));
}

double at_share(std::vector<double> values, double share)
{
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// A governor that is compared.
struct Watcher
{
    std::string id;
    simulation::Ladder ladder;
    std::vector<std::string> watched;

    /// The k-th of `count` choices of one level for all: ladders of different lengths have their ends in common.
    std::size_t level_of_choice(std::size_t k, std::size_t count) const
    {
        return (k * (ladder.levels.size() - 1) + (count - 1) / 2) / (count - 1);
    }
};

/// One of the runs that are compared, with its figures so far.
struct Contender
{
    GovernPoint point;
    std::unique_ptr<Simulation> run;
    bool shares_snapshot = false;  ///< since the last step
    double looks = 0;              ///< how often the levels were counted
};

class Comparison
{
public:
    Comparison(model::TypeSource& types, const GovernPlan& plan) : types_(types), plan_(plan) {}

    Result<GovernResult> run()
    {
        if (auto ready = begin(); !ready) return ready.errors();
        for (double end = plan_.between; end <= plan_.until + 1e-9; end += plan_.between)
            // One after the other within each interval, so that a busy machine slows all of them alike.
            for (Contender& c : contenders_)
            {
                if (plan_.progress)
                    plan_.progress(plan_.title + ": " + c.point.name + ", " + std::to_string(static_cast<int>(end - plan_.between)) +
                                   " s of " + std::to_string(static_cast<int>(plan_.until)) + " s");
                if (auto done = advance(c, end); !done) return done.errors();
            }
        for (Contender& c : contenders_) finish(c);
        return std::move(out_);
    }

    Result<GovernResult> list()
    {
        if (auto ready = begin(); !ready) return ready.errors();
        return std::move(out_);
    }

private:
    Result<void> begin()
    {
        if (auto added = add_governed("governed", plan_.scene); !added) return added;
        Simulation& governed = *contenders_.front().run;
        if (auto found = choose_governors(governed); !found) return found;
        if (governed.viewpoints().empty()) return reason("the scene has no viewer, for whom an error in pixels could be told");
        for (const Setting& variant : plan_.variants)
        {
            const auto scene = apply(plan_.scene, types_, {variant});
            if (!scene) return scene.errors();
            if (auto added = add_governed("governed, " + variant.text(), *scene); !added) return added;
        }
        for (std::size_t k = 0; k < choices(); ++k)
        {
            Contender fixed;
            fixed.point.name = name_of_choice(k), fixed.run = std::make_unique<Simulation>(types_);
            if (auto loaded = fixed.run->load(plan_.scene); !loaded) return loaded;
            fixed.run->let_measure(true);  // for other governors of the scene
            for (const Watcher& w : governors_)
            {
                if (auto removed = ask_now(*fixed.run, {simulation::RemoveOperation{w.id}}); !removed) return removed;
                const simulation::Level& level = w.ladder.levels[w.level_of_choice(k, choices())];
                if (auto given = give_all(*fixed.run, w.watched, level); !given) return given;
            }
            out_.levels.push_back(fixed.point.name);
            contenders_.push_back(std::move(fixed));
        }
        reference_ = std::make_unique<Simulation>(types_);
        reference_->let_decide(false);
        return {};
    }

    Result<void> add_governed(const std::string& name, const model::SceneSpec& scene)
    {
        Contender governed;
        governed.point.name = name, governed.point.governed = true;
        governed.run = std::make_unique<Simulation>(types_);
        if (auto loaded = governed.run->load(scene); !loaded) return loaded;
        governed.run->let_measure(true);
        contenders_.push_back(std::move(governed));
        return {};
    }

    std::size_t choices() const
    {
        std::size_t out = 0;
        for (const Watcher& w : governors_) out = std::max(out, w.ladder.levels.size());
        return out;
    }

    std::string name_of_choice(std::size_t k) const
    {
        if (governors_.size() == 1) return governors_.front().ladder.levels[k].text;
        if (k == 0) return "cheapest levels";
        return k + 1 == choices() ? std::string("most exact levels")
                                  : "levels " + std::to_string(k + 1) + " of " + std::to_string(choices());
    }

    bool is_chosen(const std::string& id) const
    {
        if (plan_.governor.empty()) return governors_.empty() || governors_.front().id == id;
        return simulation::matches_any(plan_.governor, id);
    }

    Result<void> choose_governors(const Simulation& s)
    {
        const world::World& world = s.world();
        for (const LevelInfo& l : s.levels().levels())
        {
            const std::string& id = world.id_of(l.governor);
            if (!is_chosen(id)) continue;
            if (governors_.empty() || governors_.back().id != id)
                if (auto added = add_governor(s, l.governor); !added) return added;
            governors_.back().watched.push_back(world.id_of(l.component));
            ++out_.components;
            for (const Ref object : s.levels().objects_of(l.component))
                if (object.facet == Facet::Body) objects_.push_back(world.id_of(object));
        }
        if (governors_.empty())
            return reason(plan_.governor.empty() ? std::string("no governor of the scene watches anything")
                                                 : "no governor '" + plan_.governor + "' of the scene watches anything");
        std::sort(objects_.begin(), objects_.end());
        objects_.erase(std::unique(objects_.begin(), objects_.end()), objects_.end());
        out_.title = plan_.title, out_.command = plan_.command, out_.scene_file = plan_.scene.file;
        out_.until = plan_.until, out_.between = plan_.between, out_.window = plan_.window, out_.dt = s.dt(), out_.refine = plan_.refine;
        out_.objects = objects_.size();
        return {};
    }

    Result<void> add_governor(const Simulation& s, std::uint32_t governor)
    {
        const world::World& world = s.world();
        const Value levels = world.get(governor, "levels"), budget = world.get(governor, "budget"), share = world.get(governor, "share");
        auto ladder = simulation::read_ladder(std::get<std::string>(levels), types_);
        if (!ladder) return ladder.errors();
        governors_.push_back({world.id_of(governor), ladder.take(), {}});
        if (const auto* b = std::get_if<double>(&budget)) out_.budget = *b > 0 ? *b : std::get<double>(share) * s.dt();
        out_.governor += (out_.governor.empty() ? "" : ", ") + world.id_of(governor);
        const std::string& type = world.type_of(governor)->info.name;
        if (out_.type.find(type) == std::string::npos) out_.type += (out_.type.empty() ? "" : ", ") + type;
        return {};
    }

    Result<void> step(Contender& c)
    {
        if (plan_.stop && plan_.stop->due()) return reason("interrupted");
        const double begin = thread_cpu_seconds();
        (void)c.run->step();
        // The first step after a snapshot copies what it shares with that. This is not what the scene costs.
        if (std::exchange(c.shares_snapshot, false)) return {};
        const simulation::DecisionCost& decided = c.run->levels().decision_cost();
        c.point.steps.push_back(
            {thread_cpu_seconds() - begin, decided.trying.processor + decided.exchanging.processor, decided.trials, decided.exchanged});
        return {};
    }

    Result<void> advance(Contender& c, double end)
    {
        const double half = 0.5 * c.run->dt(), compared_from = end - plan_.window;
        while (c.run->time() < compared_from - half)
            if (auto made = step(c); !made) return made;
        if (auto ready = begin_reference(*c.run); !ready) return ready;
        c.shares_snapshot = true;
        // One after the other, so that the run finds its data where it left them.
        int steps = 0;
        for (; c.run->time() < end - half; ++steps)
            if (auto made = step(c); !made) return made;
        for (int k = 0; k < steps * plan_.refine; ++k) (void)reference_->step_once();
        add_errors(*c.run, *reference_, pairs(*c.run), c.point.error);
        count_levels(c);
        return {};
    }

    /// From the state of the run, with the most exact level for all and shorter steps.
    Result<void> begin_reference(const Simulation& run)
    {
        if (auto restored = reference_->restore(run.capture()); !restored) return restored;
        for (const Watcher& w : governors_)
            if (auto given = give_all(*reference_, w.watched, w.ladder.levels.back()); !given) return given;
        model::StepLength dt = plan_.scene.settings.dt;
        dt.seconds /= plan_.refine;
        if (dt.denominator > 0) dt.denominator *= plan_.refine;
        return ask_now(*reference_, {simulation::StepLengthOperation{dt}});
    }

    static Ref ref_of(const Simulation& run, const std::string& id)
    {
        const std::uint32_t component = run.world().find(id);
        return run.world().component(component).ref(component);
    }

    std::vector<ObjectPair> pairs(const Simulation& run) const
    {
        std::vector<ObjectPair> out;
        for (const std::string& id : objects_)
            if (ObjectPair pair; find_pair(run, *reference_, ref_of(run, id), pair)) out.push_back(pair);
        return out;
    }

    /// A ladder that is shorter than others fills the choices that it shares with them.
    void count_levels(Contender& c)
    {
        c.point.shares.resize(choices());
        ++c.looks;
        for (const LevelInfo& l : c.run->levels().levels())
            for (const Watcher& w : governors_)
                if (l.level >= 0 && c.run->world().id_of(l.governor) == w.id)
                    c.point.shares[static_cast<std::size_t>(l.level) * (choices() - 1) / (w.ladder.levels.size() - 1)] +=
                        1.0 / static_cast<double>(out_.components);
    }

    void finish(Contender& c)
    {
        std::vector<double> steps;
        for (const GovernStep& s : c.point.steps) steps.push_back(s.seconds);
        double cpu = 0;
        for (const double s : steps) cpu += s;
        c.point.cpu = cpu / (std::max<double>(1, static_cast<double>(steps.size())) * c.run->dt());
        c.point.step_median = at_share(steps, 0.5), c.point.step_99 = at_share(steps, 0.99), c.point.step_longest = at_share(steps, 1);
        take_mean(c.point.error);
        for (double& s : c.point.shares) s /= std::max(1.0, c.looks);
        out_.points.push_back(std::move(c.point));
    }

    model::TypeSource& types_;
    const GovernPlan& plan_;
    GovernResult out_;
    std::vector<Watcher> governors_;
    std::vector<std::string> objects_;   ///< bodies on which the watched components act, sorted
    std::vector<Contender> contenders_;  ///< the governed one first
    std::unique_ptr<Simulation> reference_;
};

}  // namespace

Result<GovernResult> compare_governor(model::TypeSource& types, const GovernPlan& plan) { return Comparison(types, plan).run(); }

Result<GovernResult> governed_levels(model::TypeSource& types, const GovernPlan& plan) { return Comparison(types, plan).list(); }

std::optional<double> gain(const GovernResult& result) { return gain(result, result.points.front()); }

const GovernPoint* better_than(const GovernResult& result, const GovernPoint& fixed)
{
    const GovernPoint* out = nullptr;
    for (const GovernPoint& p : result.points)
        if (p.governed && p.cpu < fixed.cpu && p.error.pixels < fixed.error.pixels && (!out || p.cpu < out->cpu)) out = &p;
    return out;
}

std::optional<double> gain(const GovernResult& result, const GovernPoint& governed)
{
    std::vector<const GovernPoint*> fixed;
    for (const GovernPoint& p : result.points)
        if (!p.governed && p.cpu > 0 && p.error.pixels > 0) fixed.push_back(&p);
    std::sort(fixed.begin(), fixed.end(), [](const GovernPoint* a, const GovernPoint* b) { return a->cpu < b->cpu; });
    const GovernPoint* before = nullptr;  // of the front
    for (const GovernPoint* p : fixed)
    {
        if (before && p->error.pixels >= before->error.pixels) continue;
        const double error = governed.error.pixels;
        if (before && error <= before->error.pixels && error >= p->error.pixels && error > 0)
        {
            const double part = std::log(before->error.pixels / error) / std::log(before->error.pixels / p->error.pixels);
            return before->cpu * std::pow(p->cpu / before->cpu, part) / governed.cpu;
        }
        before = p;
    }
    return {};
}

}  // namespace plab::study
