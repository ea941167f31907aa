// Where components hand in what they decide: the host's side of plab/levels.h.
#include <algorithm>
#include <cassert>
#include <limits>

#include "simulation/costs/clock.h"
#include "simulation/levels/level_book.h"
#include "world/command_call.h"
#include "world/world_lookup.h"

namespace plab::simulation
{

class LevelBook::Desk final : public LevelControl, public ViewpointSink, public RequestSink
{
public:
    Desk(LevelBook& book, const MeasureError& error) : book_(book), error_(error), lookup_(book.world_, book.structure_)
    {
        book_.viewpoints_.clear(), book_.looked_.clear();
    }
    const Lookup& lookup() const { return lookup_; }

    /// The calls that follow come from this component.
    void serve(std::uint32_t component);
    /// The component's command failed.
    void refuse(const std::string& why, EventSink& events, double time, Tick tick) const;
    std::vector<Decision> take() { return std::move(decisions_); }

    // ViewpointSink
    void add(Row row, const Viewpoint& viewpoint) override;

    // LevelControl
    std::int32_t levels(Row row) const override;
    std::span<const GovernedComponent> watched(Row row) override;
    std::span<const Viewpoint> viewpoints() const override { return book_.viewpoints_; }
    std::string_view id_of(std::uint32_t component) const override;
    LevelError error(Row row, std::size_t index, std::int32_t level, double interval) override;
    void tell(Row row, std::size_t index, double error, std::string_view unit, double next_look) override;
    void choose(Row row, std::size_t index, std::int32_t level, std::string reason) override;

    // RequestSink
    void ask(Row row, std::string_view verb, std::string_view target, std::string_view argument, std::string reason) override;

private:
    LevelBook& book_;
    const MeasureError& error_;
    world::WorldLookup lookup_;
    std::uint32_t by_ = kNoIndex;
    Governor* governor_ = nullptr;  ///< null: the component watches nothing
    bool chose_ = false;            ///< the last decision has choices of this component
    std::vector<Decision> decisions_;
};

void LevelBook::Desk::serve(std::uint32_t component)
{
    by_ = component, governor_ = nullptr, chose_ = false;
    book_.looked_.clear();
    for (Governor& g : book_.governors_)
        if (g.component == component) governor_ = &g;
}

void LevelBook::Desk::refuse(const std::string& why, EventSink& events, double time, Tick tick) const
{
    Event e;
    e.tick = tick, e.time = time, e.kind = "decide.failed", e.severity = Severity::Warning, e.component = by_, e.message = why;
    events.emit(std::move(e));
}

void LevelBook::Desk::add(Row /*row*/, const Viewpoint& viewpoint)
{
    book_.viewpoints_.push_back(viewpoint);
    book_.viewpoints_.back().component = by_;
}

std::int32_t LevelBook::Desk::levels(Row /*row*/) const
{
    return governor_ ? static_cast<std::int32_t>(governor_->ladder.levels.size()) : 0;
}

std::span<const GovernedComponent> LevelBook::Desk::watched(Row /*row*/)
{
    if (governor_ && book_.looked_.empty())
        for (const Watched& w : governor_->watched) book_.looked_.push_back(book_.look(*governor_, w));
    return book_.looked_;
}

std::string_view LevelBook::Desk::id_of(std::uint32_t component) const
{
    return component < book_.ids_.size() ? std::string_view(book_.ids_[component]) : std::string_view();
}

LevelError LevelBook::Desk::error(Row /*row*/, std::size_t index, std::int32_t level, double interval)
{
    assert(governor_ && index < governor_->watched.size() && level >= 0);
    const auto& levels = governor_->ladder.levels;
    const auto at = static_cast<std::size_t>(level);
    if (at + 1 == levels.size()) return {0, 0, 0};
    if (at >= levels.size() || !error_) return {};
    const std::uint32_t component = governor_->watched[index].component;
    constexpr std::size_t kMostMeasured = 64;
    const std::uint64_t begin = now_ns(), thread_begin = thread_ns();
    const TrialFindings found = error_({component, &levels[at], &levels[at + 1], interval, book_.enough_for(*governor_),
                                        governor_->trials < kMostMeasured, governor_->counts_energy});
    book_.note_tried(*governor_, {1e-9 * static_cast<double>(now_ns() - begin), 1e-9 * static_cast<double>(thread_ns() - thread_begin)});
    note_trial(*governor_, index, level, interval, found, book_.trials_[component]);
    return found.error;
}

void LevelBook::Desk::tell(Row /*row*/, std::size_t index, double error, std::string_view unit, double next_look)
{
    assert(governor_ && index < governor_->watched.size());
    const std::uint32_t component = governor_->watched[index].component;
    Told& told = book_.told_[component];
    told.by = by_, told.error = error, told.next_look = next_look;
    told.unit = unit;
    book_.changed_.push_back(component);
}

void LevelBook::Desk::choose(Row /*row*/, std::size_t index, std::int32_t level, std::string reason)
{
    assert(governor_ && index < governor_->watched.size() && level >= 0 && level < levels(0));
    // What was told of the level that it loses says nothing of the one that it gets.
    const std::uint32_t component = governor_->watched[index].component;
    Told& told = book_.told_[component];
    book_.known_[component].told_before = told.by == by_ ? told.error : std::numeric_limits<double>::quiet_NaN();
    if (told.by == by_) told.error = told.next_look = std::numeric_limits<double>::quiet_NaN();
    if (!chose_) decisions_.emplace_back().by = by_;
    chose_ = true;
    const Level& to = governor_->ladder.levels[static_cast<std::size_t>(level)];
    decisions_.back().operations.push_back(SwapOperation{book_.world_.id_of(component), to.type, to.values});
    decisions_.back().reasons.push_back(std::move(reason));
}

void LevelBook::Desk::ask(Row /*row*/, std::string_view verb, std::string_view target, std::string_view argument, std::string reason)
{
    chose_ = false;
    Decision& d = decisions_.emplace_back();
    d.by = by_, d.verb = verb, d.target = target, d.argument = argument;
    d.reasons.push_back(std::move(reason));
}

world::CommandCall LevelBook::call_at(Tick tick, double time, double dt, Desk& desk) const
{
    world::CommandCall call;
    call.context.time = time, call.context.dt = dt, call.context.tick = tick, call.context.seed = world_.scene().settings.seed;
    world::HostTables& host = world_.host();
    call.arguments.bodies = &host.bodies, call.arguments.shafts = &host.shafts, call.arguments.quantities = &host.quantities;
    call.arguments.shapes = &host.shapes;
    call.context.lookup = &desk.lookup();
    call.arguments.viewpoints = &desk, call.arguments.levels = &desk, call.arguments.requests = &desk;
    return call;
}

std::vector<Decision> LevelBook::decide(Tick tick, double time, double dt, const MeasureError& error, EventSink& events)
{
    Desk desk(*this, error);
    world::CommandCall call = call_at(tick, time, dt, desk);
    call.context.events = &events;
    decided_ = {};
    deciding_ = true;
    for (const Phase phase : {Phase::View, Phase::Decide})
        for (const Block& block : stepper_.schedule().of(phase))
        {
            const world::Table& table = *world_.tables()[block.table];
            call.select(table);
            for (const Row& row : block.rows)
            {
                const std::uint32_t component = table.component_of_row()[row];
                const std::uint64_t begin = now_ns();
                desk.serve(component);
                if (auto done = call.run(*block.command, Rows(&row, 1)); !done) desk.refuse(done.error().reason, events, time, tick);
                if (block.alone) stepper_.charge(component, static_cast<std::int64_t>(now_ns() - begin));
            }
        }
    deciding_ = false;
    return desk.take();
}

std::vector<Viewpoint> LevelBook::viewpoints(Tick tick, double time, double dt)
{
    const MeasureError none;
    Desk desk(*this, none);
    world::CommandCall call = call_at(tick, time, dt, desk);
    for (const Block& block : stepper_.schedule().of(Phase::View))
    {
        const world::Table& table = *world_.tables()[block.table];
        call.select(table);
        for (const Row& row : block.rows)
        {
            desk.serve(table.component_of_row()[row]);
            (void)call.run(*block.command, Rows(&row, 1));
        }
    }
    return viewpoints_;
}

}  // namespace plab::simulation
