#include "simulation/levels/desk.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace plab::simulation
{

void LevelBook::Desk::serve(std::uint32_t component)
{
    by_ = component, governor_ = nullptr, chose_ = false;
    looked_.clear();
    for (const Governor& g : book_.governors_)
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
    viewpoints_.push_back(viewpoint);
    viewpoints_.back().component = by_;
}

std::int32_t LevelBook::Desk::levels(Row /*row*/) const
{
    return governor_ ? static_cast<std::int32_t>(governor_->ladder.levels.size()) : 0;
}

std::span<const GovernedComponent> LevelBook::Desk::watched(Row /*row*/)
{
    if (governor_ && looked_.empty())
        for (const Watched& w : governor_->watched) looked_.push_back(book_.look(*governor_, w));
    return looked_;
}

double LevelBook::Desk::error(Row /*row*/, std::size_t index, std::int32_t level, double interval)
{
    assert(governor_ && index < governor_->watched.size());
    const auto& levels = governor_->ladder.levels;
    const auto at = static_cast<std::size_t>(level);
    if (at >= levels.size() || !error_) return std::numeric_limits<double>::quiet_NaN();
    if (at + 1 == levels.size()) return 0;
    return error_(governor_->watched[index].component, &levels[at], &levels.back(), interval);
}

void LevelBook::Desk::choose(Row /*row*/, std::size_t index, std::int32_t level, std::string reason)
{
    assert(governor_ && index < governor_->watched.size() && level >= 0 && level < levels(0));
    if (!chose_) decisions_.emplace_back().by = by_;
    chose_ = true;
    const Level& to = governor_->ladder.levels[static_cast<std::size_t>(level)];
    decisions_.back().operations.push_back(SwapOperation{book_.world_.id_of(governor_->watched[index].component), to.type, to.values});
    decisions_.back().reasons.push_back(std::move(reason));
}

void LevelBook::Desk::ask(Row /*row*/, std::string_view verb, std::string_view target, std::string_view argument, std::string reason)
{
    chose_ = false;
    Decision& d = decisions_.emplace_back();
    d.by = by_, d.verb = verb, d.target = target, d.argument = argument;
    d.reasons.push_back(std::move(reason));
}

}  // namespace plab::simulation
