#include "study/verify.h"

#include <algorithm>
#include <cmath>

#include "study/island_energy.h"
#include "study/shadow.h"

namespace plab::study
{
namespace
{

using simulation::LevelInfo;
using simulation::Simulation;

template <class T>
T field_of(const world::World& world, std::uint32_t component, const char* name, T otherwise)
{
    if (!world.type_of(component) || !world.type_of(component)->schema.find_field(name)) return otherwise;
    const Value value = world.get(component, name);
    const auto* is = std::get_if<T>(&value);
    return is ? *is : otherwise;
}

/// The governors of a run that state a bound, in id order.
std::vector<std::uint32_t> governors_with_bound(const Simulation& run)
{
    std::vector<std::uint32_t> out;
    for (const LevelInfo& l : run.levels().levels())
        if (field_of(run.world(), l.governor, "bound", 0.0) > 0 && (out.empty() || out.back() != l.governor)) out.push_back(l.governor);
    return out;
}

}  // namespace

/// The interval of one governor that is being measured.
class LevelVerifier::Window
{
public:
    Window(model::TypeSource& types, const Simulation& run, std::uint32_t governor)
        : shadow_(types), types_(types), estimates_(types, field_of(run.world(), governor, "unit", std::string()))
    {
        const world::World& world = run.world();
        out_.id = world.id_of(governor), out_.type = world.type_of(governor)->info.name;
        out_.unit = field_of(world, governor, "unit", std::string("m"));
        out_.bound = field_of(world, governor, "bound", 0.0), out_.interval = field_of(world, governor, "interval", 0.25);
        shadow_.let_decide(false);
    }

    Result<void> at_boundary(Simulation& run)
    {
        const std::uint32_t governor = run.world().find(out_.id);
        if (governor == kNoIndex)
        {
            open_ = false;
            return {};
        }
        if (open_)
        {
            (void)shadow_.step_once();
            if (estimates_.is_open())
                if (auto followed = estimates_.follow(shadow_); !followed) return followed;
            if (auto compared = compare(run); !compared) return compared;
            if (run.time() >= interval_.begin + out_.interval - 0.5 * run.dt()) close(run, governor);
        }
        return open_ ? Result<void>() : open(run, governor);
    }
    void drop() { open_ = false, estimates_.drop(); }
    VerifiedGovernor take() { return std::move(out_); }

private:
    struct Component
    {
        std::uint32_t index = 0;
        std::vector<ObjectPair> objects;
        double error = 0;
        bool counts = false;
    };

    Result<void> open(Simulation& run, std::uint32_t governor)
    {
        const simulation::Snapshot state = run.capture();
        if (auto restored = shadow_.restore(state); !restored) return restored;
        auto ladder = simulation::read_ladder(field_of(run.world(), governor, "levels", std::string()), types_);
        if (!ladder) return ladder.errors();
        finest_ = static_cast<std::int32_t>(ladder->levels.size()) - 1;
        std::vector<std::string> watched;
        components_.clear();
        for (const LevelInfo& l : run.levels().levels())
        {
            if (l.governor != governor) continue;
            watched.push_back(run.world().id_of(l.component));
            Component& c = components_.emplace_back();
            c.index = l.component;
        }
        if (opened_++ % kBetweenEstimates == 0)
            if (auto begun = estimates_.open(shadow_, state, *ladder, watched, out_.interval, run.levels()); !begun) return begun;
        if (auto given = give_all(shadow_, watched, ladder->levels.back()); !given) return given;
        // The exchange may have given the shadow other rows.
        for (Component& c : components_)
            for (const Ref object : run.levels().objects_of(c.index))
                if (ObjectPair pair; find_pair(run, shadow_, object, pair)) c.objects.push_back(pair);
        out_.components = components_.size();
        if (by_energy()) energies_.begin(run);
        interval_ = {}, interval_.begin = run.time(), revision_ = run.revision(), open_ = true;
        return {};
    }

    /// Rows may have moved when the governor exchanged components.
    void find_rows(const Simulation& run)
    {
        if (revision_ == run.revision()) return;
        revision_ = run.revision();
        for (Component& c : components_)
        {
            c.objects.clear();
            for (const Ref object : run.levels().objects_of(c.index))
                if (ObjectPair pair; find_pair(run, shadow_, object, pair)) c.objects.push_back(pair);
        }
    }

    bool by_energy() const { return out_.unit == "W"; }

    /// The island's: what it made or lost since the interval began, at most, divided by the interval.
    double power_of(const Simulation& run, const Component& c)
    {
        objects_.clear();
        for (const ObjectPair& p : c.objects) objects_.push_back({p.facet, p.here});
        return std::fabs(energies_.excess(run, objects_)) / out_.interval;
    }

    Result<void> compare(Simulation& run)
    {
        find_rows(run);
        if (by_energy())
            if (auto looked = energies_.look(run, shadow_); !looked) return looked;
        const bool by_sight = out_.unit == "pixels";
        const std::vector<Viewpoint> eyes = by_sight ? run.viewpoints() : std::vector<Viewpoint>();
        const world::HostTables& host = run.world().host();
        for (Component& c : components_)
        {
            const auto level = run.levels().level(c.index);
            const bool exact = level && level->level == finest_;
            bool seen = !by_sight;
            if (by_energy()) c.error = std::max(c.error, power_of(run, c));
            for (const ObjectPair& p : by_energy() ? std::span<const ObjectPair>() : std::span<const ObjectPair>(c.objects))
            {
                const Apart a = apart(run, shadow_, p);
                const double scale = by_sight && p.facet == Facet::Body ? pixels_per_metre(eyes, host.bodies.position[p.here]) : 1;
                seen = seen || scale > 0;
                c.error = std::max(c.error, out_.unit == "rad" ? a.radians : scale * a.metres);
            }
            c.counts = c.counts || (seen && !exact);
        }
        return {};
    }

    void close(const Simulation& run, std::uint32_t governor)
    {
        open_ = false;
        estimates_.close(out_.estimates);
        for (const Component& c : components_)
        {
            if (!c.counts) continue;
            ++interval_.counted, interval_.held += c.error <= out_.bound ? 1 : 0;
            if (interval_.counted > 1 && c.error <= interval_.worst.error) continue;
            const auto level = run.levels().level(c.index);
            interval_.worst = {run.world().id_of(c.index), level ? level->text : std::string(), interval_.begin, c.error};
        }
        out_.confidence = field_of(run.world(), governor, "confidence", 0.0);
        out_.intervals.push_back(interval_);
    }

    VerifiedGovernor out_;
    Simulation shadow_;
    model::TypeSource& types_;
    std::int32_t finest_ = 0;
    std::vector<Component> components_;
    VerifiedInterval interval_;
    std::uint64_t revision_ = 0;
    bool open_ = false;
    static constexpr std::size_t kBetweenEstimates = 4;  ///< intervals
    std::size_t opened_ = 0;
    EstimateCheck estimates_;
    IslandEnergies energies_;
    std::vector<Ref> objects_;  ///< of one component
};

std::size_t VerifiedGovernor::counted() const
{
    std::size_t sum = 0;
    for (const VerifiedInterval& i : intervals) sum += i.counted;
    return sum;
}

std::size_t VerifiedGovernor::held() const
{
    std::size_t sum = 0;
    for (const VerifiedInterval& i : intervals) sum += i.held;
    return sum;
}

double VerifiedGovernor::share() const { return counted() == 0 ? 1 : static_cast<double>(held()) / static_cast<double>(counted()); }

const VerifiedLevel* VerifiedGovernor::worst() const
{
    const VerifiedLevel* out = nullptr;
    for (const VerifiedInterval& i : intervals)
        if (i.counted > 0 && (!out || i.worst.error > out->error)) out = &i.worst;
    return out;
}

LevelVerifier::LevelVerifier(model::TypeSource& types) : types_(types) {}
LevelVerifier::~LevelVerifier() = default;

Result<void> LevelVerifier::begin_run(const Simulation& run)
{
    for (const auto& window : windows_) window->drop();
    if (windows_.empty())
        for (const std::uint32_t governor : governors_with_bound(run)) windows_.push_back(std::make_unique<Window>(types_, run, governor));
    if (!begun_) out_.from = run.time(), out_.objects = body_pairs(run, run).size();
    run_ = run.run(), begun_ = true;
    return {};
}

Result<void> LevelVerifier::at_boundary(Simulation& run)
{
    if (!begun_ || run.run() != run_)
        if (auto begun = begin_run(run); !begun) return begun;
    for (const auto& window : windows_)
        if (auto done = window->at_boundary(run); !done) return done;
    out_.until = run.time();
    return {};
}

Result<VerifyResult> LevelVerifier::take()
{
    if (windows_.empty()) return reason("no governor of the scene states a bound that could be checked: that does Governor/Error");
    for (const auto& window : windows_) out_.governors.push_back(window->take());
    windows_.clear();
    return std::move(out_);
}

}  // namespace plab::study
