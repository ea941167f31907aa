#include "simulation/shafts/coupling_watch.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "plab/number_text.h"
#include "world/command_call.h"

namespace plab::simulation
{
namespace
{

/// Calls a Couple command on shafts of inertia 1, the driven one at rest and all others at a given speed. What the command applies
/// reveals its factor.
class FactorProbe final : public ShaftMotion
{
public:
    explicit FactorProbe(double speed) : speed_(speed) {}
    void begin(std::uint32_t component, Ref driven) override { pair_.component = component, driven_ = driven, begun_ = true; }
    double rate(Ref shaft) const override { return shaft == driven_ ? 0.0 : speed_; }
    double mobility(Ref) const override { return 1; }
    void apply(Ref shaft, double torque) override
    {
        if (shaft == driven_)
            on_driven_ += torque;
        else
            driver_ = shaft, on_driver_ += torque;
    }
    void assign(Ref, double rate) override { assigned_ = rate, pair_.one_way = true; }

    bool did_anything() const { return on_driven_ != 0 || on_driver_ != 0 || assigned_ != 0; }
    /// `driver`: the driver of the row, for commands that do not act on it.
    std::optional<CouplingPair> pair(Ref driver) const
    {
        CouplingPair out = pair_;
        const Ref from = pair_.one_way ? driver : driver_;
        if (!begun_ || from.facet != Facet::Shaft || driven_.facet != Facet::Shaft || from == driven_) return {};
        out.driver = from.index, out.driven = driven_.index;
        out.factor = pair_.one_way ? assigned_ / speed_ : -on_driver_ / on_driven_;
        if (!std::isfinite(out.factor) || out.factor == 0) return {};
        return out;
    }

private:
    double speed_;
    CouplingPair pair_;
    Ref driver_, driven_;
    double on_driver_ = 0, on_driven_ = 0, assigned_ = 0;
    bool begun_ = false;
};

FactorProbe probed(const Block& block, const world::Table& table, Row row, double speed)
{
    FactorProbe probe(speed);
    world::CommandCall call;
    call.arguments.shaft_motion = &probe;
    call.select(table);
    (void)call.run(*block.command, Rows(&row, 1));  // as in the sweeps
    return probe;
}

std::string shaft_id(const world::World& world, std::uint32_t shaft) { return world.id_of(Ref{Facet::Shaft, shaft}); }

}  // namespace

void CouplingWatch::rebuild(const world::World& world, const Schedule& schedule, const ConstraintGraph& graph,
                            const ShaftDirectory& directory)
{
    pairs_.clear();
    for (const Block& block : schedule.of(Phase::Couple))
    {
        const world::Table& table = *world.tables()[block.table];
        const Role* driver = table.schema().find_role("driver");
        for (const Row row : block.rows)
        {
            // A command that acts on shafts at rest enforces something other than a ratio.
            if (probed(block, table, row, 0).did_anything()) continue;
            const Ref from = driver && driver->one ? (*driver->one)[row] : Ref{};
            if (const auto pair = probed(block, table, row, 1).pair(from)) pairs_.push_back(*pair);
        }
    }
    find_contradictions(world, graph, directory);
}

/// The edges of the graph in the trees that a pair has a shaft of: no other can be in a loop with a pair.
std::vector<RatioEdge> CouplingWatch::edges_beside(const ConstraintGraph& graph) const
{
    std::vector<const ShaftTree*> trees;
    for (const CouplingPair& p : pairs_)
        for (const std::uint32_t shaft : {p.driver, p.driven})
            if (const ShaftTree* tree = graph.tree_of(shaft)) trees.push_back(tree);
    std::sort(trees.begin(), trees.end(), std::less<>());
    std::vector<RatioEdge> out;
    for (const RatioEdge& e : graph.edges())
        if (std::binary_search(trees.begin(), trees.end(), graph.tree_of(e.driver), std::less<>())) out.push_back(e);
    return out;
}

/// The couplings of the graph are consistent with one another, so they come first; the edge that closes a contradictory loop is then one
/// of the pairs.
void CouplingWatch::find_contradictions(const world::World& world, const ConstraintGraph& graph, const ShaftDirectory& directory)
{
    faults_.clear();
    if (pairs_.empty()) return;
    std::vector<RatioEdge> edges = edges_beside(graph);
    std::vector<std::uint32_t> rank(world.components().size());
    for (std::uint32_t c = 0; c < rank.size(); ++c) rank[c] = directory.rank_of_component(c);
    for (const CouplingPair& p : pairs_)
    {
        Ratio ratio;
        ratio.value = p.factor;
        if (const auto factor = ExactRatio::from(ratio)) edges.push_back({p.component, p.driver, p.driven, *factor});
        rank[p.component] += static_cast<std::uint32_t>(rank.size());
    }
    ShaftDirectory pairs_last = directory;
    pairs_last.component_rank = rank;
    // Whether prescribed shafts agree depends on their speeds and not on the loops, so none is marked as prescribed here.
    const std::vector<std::uint8_t> prescribed(world.host().shafts.size(), 0);
    const auto forest = grow_ratio_forest(std::move(edges), prescribed, pairs_last);
    if (forest) return;
    for (const Error& e : forest.errors())
    {
        const std::uint32_t component = world.find(e.element);
        const auto pair = std::find_if(pairs_.begin(), pairs_.end(), [&](const CouplingPair& p) { return p.component == component; });
        if (pair != pairs_.end()) faults_.push_back({static_cast<std::size_t>(pair - pairs_.begin()), e.reason});
    }
}

void CouplingWatch::emit(const char* kind, std::uint32_t component, std::string message, std::vector<double> values)
{
    Event e;
    e.time = time_, e.kind = kind, e.severity = Severity::Warning, e.component = component;
    e.message = std::move(message), e.values = std::move(values);
    events_->emit(std::move(e));
}

void CouplingWatch::report(const world::World& world, const ShaftSystem& system, const CouplingReport& done, double time, EventSink& events,
                           std::vector<std::uint8_t>& reported)
{
    time_ = time, events_ = &events;
    report_conflict(world, done, reported);
    for (const Fault& fault : faults_) report_fault(fault, world.host().shafts, done, reported);
    misses_.clear();
    for (std::size_t i = 0; i < pairs_.size(); ++i) check_pair(i, world, system, reported);
    if (!misses_.empty()) report_unsettled(world.host().shafts, done.sweeps, reported);
}

void CouplingWatch::report_conflict(const world::World& world, const CouplingReport& done, std::vector<std::uint8_t>& reported)
{
    const std::uint32_t second = done.conflict ? done.conflict->second : kNoIndex;
    if (done.conflict && reported[second] == 0)
        emit("coupling.conflict", second,
             "drives " + shaft_id(world, done.conflict->shaft) + " against " + world.id_of(done.conflict->first) +
                 ", which takes precedence",
             {});
    for (const CouplingPair& p : pairs_)
        if (p.one_way) reported[p.component] = p.component == second ? 1 : 0;
}

bool CouplingWatch::is_faulty(std::uint32_t part, const ShaftSystem& system) const
{
    return std::any_of(faults_.begin(), faults_.end(), [&](const Fault& f) { return system.part_of(pairs_[f.pair].driven) == part; });
}

void CouplingWatch::report_fault(const Fault& fault, const Shafts& shafts, const CouplingReport& done, std::vector<std::uint8_t>& reported)
{
    const CouplingPair& p = pairs_[fault.pair];
    if (std::exchange(reported[p.component], 1)) return;
    const double left = std::fabs(shafts.speed[p.driven] - p.factor * shafts.speed[p.driver]);
    emit("constraint.contradiction", p.component,
         fault.why + "; only rest satisfies this loop, so the sweeps brake it; an error of " + rounded_text(left) +
             " rad/s remains at present",
         {left, done.residual});
}

/// Checks the speeds of one pair: they agree, or are reported at once if nothing can correct them, or are recorded as a miss.
void CouplingWatch::check_pair(std::size_t index, const world::World& world, const ShaftSystem& system, std::vector<std::uint8_t>& reported)
{
    const CouplingPair& p = pairs_[index];
    if (p.one_way) return;  // conflicts are reported separately
    const bool named = std::any_of(faults_.begin(), faults_.end(), [&](const Fault& f) { return f.pair == index; });
    if (named) return;
    const Shafts& shafts = world.host().shafts;
    // Relative to the largest speeds during the sweeps: if shafts stop one another, what remains is rounding.
    const double size = std::fmax(std::fabs(shafts.speed[p.driven]), system.scale(p.driven)) +
                        std::fabs(p.factor) * std::fmax(std::fabs(shafts.speed[p.driver]), system.scale(p.driver));
    const double miss = std::fabs(shafts.speed[p.driven] - p.factor * shafts.speed[p.driver]);
    if (!(miss > kMiss * size))
    {
        reported[p.component] = 0;
        return;
    }
    if (system.yields(p.driven) || system.yields(p.driver))
    {
        const std::uint32_t part = system.part_of(system.yields(p.driven) ? p.driven : p.driver);
        if (!is_faulty(part, system)) misses_.push_back({part, miss / size, index});
        return;
    }
    if (std::exchange(reported[p.component], 1)) return;
    emit("constraint.contradiction", p.component,
         "cannot hold: it can move neither " + shaft_id(world, p.driver) + " nor " + shaft_id(world, p.driven) + ", and an error of " +
             rounded_text(miss) + " rad/s remains; change the factor or a prescribed speed, or remove this coupling",
         {miss});
}

/// One event per train, because the sweeps distribute the error over many of its couplings.
void CouplingWatch::report_unsettled(const Shafts& shafts, int sweeps, std::vector<std::uint8_t>& reported)
{
    std::stable_sort(misses_.begin(), misses_.end(), [](const Miss& x, const Miss& y) { return x.part < y.part; });
    for (std::size_t first = 0, end = 0; first < misses_.size(); first = end)
    {
        bool known = false;
        std::size_t worst = first;
        for (; end < misses_.size() && misses_[end].part == misses_[first].part; ++end)
        {
            known = std::exchange(reported[pairs_[misses_[end].pair].component], 1) != 0 || known;
            if (misses_[end].share > misses_[worst].share) worst = end;
        }
        if (known) continue;
        const CouplingPair& p = pairs_[misses_[worst].pair];
        const std::size_t others = end - first - 1;
        emit("coupling.not_converged", p.component,
             "misses its ratio by a share of " + rounded_text(misses_[worst].share) + " of its speeds after " + std::to_string(sweeps) +
                 " sweeps" + (others > 0 ? ", and " + std::to_string(others) + "more couplings of its train by less" : std::string()) +
                 "; use Constraint/AngularVelocity/Graph, which needs no sweeps, or a shorter train",
             {shafts.speed[p.driven] - p.factor * shafts.speed[p.driver], misses_[worst].share});
    }
}

}  // namespace plab::simulation
