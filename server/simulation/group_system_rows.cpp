// The joints of a group system: their rows inside the stages, and the projection when an advance is over.
#include <algorithm>

#include "simulation/group_system.h"

namespace plab::simulation
{

void GroupSystem::configure_rows()
{
    merged_.clear(), contradictory_.clear();
    for (const std::uint32_t g : groups_)
    {
        const auto& rows = frame_.groups->all[g].rows;
        merged_.insert(merged_.end(), rows.begin(), rows.end());
    }
    std::sort(merged_.begin(), merged_.end());
    merged_.erase(std::unique(merged_.begin(), merged_.end()), merged_.end());
    rows_.reset();
    if (merged_.empty()) return;
    rows_ = std::make_unique<RowSystem>();
    rows_->configure(*frame_.world, *frame_.schedule, merged_, *frame_.graph);
}

void GroupSystem::project()
{
    context_.time = frame_.start_time + (from_ + context_.dt);
    announce_contradictions(rows_->project(context_));
    rows_->collect_cost(scratch_->cost);
}

void GroupSystem::announce_contradictions(const ProjectionReport& report)
{
    if (!context_.events) return;
    for (const std::uint32_t component : report.contradictory)
    {
        if (std::find(contradictory_.begin(), contradictory_.end(), component) != contradictory_.end()) continue;
        Event e;
        e.time = context_.time, e.kind = "constraint.contradiction", e.severity = Severity::Warning, e.component = component;
        std::string others;
        for (const std::uint32_t other : report.contradictory)
            if (other != component) others += (others.empty() ? "" : ", ") + frame_.world->id_of(other);
        e.message = "cannot hold" + (others.empty() ? std::string() : " together with " + others) + ": " +
                    std::to_string(report.position_error) + " m or rad are left, shared out by least squares";
        e.values = {report.position_error, report.speed_error};
        context_.events->emit(std::move(e));
    }
    contradictory_ = report.contradictory;
}

void GroupSystem::add_reports(RowReportTable& reports) const
{
    if (rows_) rows_->report_to(reports);
}

}  // namespace plab::simulation
