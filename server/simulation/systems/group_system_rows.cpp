// The joints of a group system: their rows inside the solver's stages, and the projection at the end of an advance.
#include <algorithm>
#include <utility>

#include "plab/number_text.h"
#include "simulation/systems/group_system.h"

namespace plab::simulation
{

void GroupSystem::configure_rows()
{
    merged_.clear(), joints_.clear();
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
    const auto& blocks = frame_.schedule->of(Phase::Constrain);
    for (const BlockRow& row : merged_) joints_.push_back(frame_.world->tables()[blocks[row.block].table]->component_of_row()[row.row]);
    forces_of_members_.clear();
    for (const std::uint32_t g : groups_)
    {
        const auto& forces = frame_.groups->all[g].forces;
        forces_of_members_.insert(forces_of_members_.end(), forces.begin(), forces.end());
    }
    force_changes_.configure(*frame_.world, *frame_.schedule, forces_of_members_);
}

void GroupSystem::join()
{
    if (!rows_) return;
    const CostScope scope(scratch_->meter(), scratch_->rows_ns);
    rows_->join(call_.context, row_book());
}

/// The state is what the tables hold, and begin() has made the speeds fit the joints; so nothing is kept from advance to advance.
std::string_view GroupSystem::use_minimal_coordinates()
{
    if (!rows_) return {};
    if (rows_held_) return "a manager holds the joints";
    Bodies& bodies = frame_.world->host().bodies;
    const CostScope scope(scratch_->meter(), scratch_->rows_ns);
    if (const std::string_view reason = tree_.recognize(bodies, bodies_, rows_->rows()); !reason.empty()) return reason;
    articulated_.start(bodies, tree_);
    const std::size_t old = body_values_;
    const std::size_t others = speeds_.size() - old;
    for (std::size_t i = 0; i < others; ++i) speeds_[articulated_.size() + i] = speeds_[old + i];
    size_vectors(articulated_.size());
    articulated_.read_speeds(bodies, speeds_);
    minimal_ = true;
    return {};
}

/// The joints' reactions in the last evaluation, in place of the multipliers that the rows would have had.
void GroupSystem::keep_reactions()
{
    if (minimal_) rows_->take_reactions(articulated_.reactions(tree_));
}

/// Joints are solved together, so the time is divided among their types by numbers of components.
void GroupSystem::share_cost_of_rows()
{
    const std::int64_t ns = std::exchange(scratch_->rows_ns, 0);
    const auto& blocks = frame_.schedule->of(Phase::Constrain);
    const auto count = static_cast<std::int64_t>(merged_.size());
    for (const BlockRow& row : merged_)
    {
        const std::uint32_t table = blocks[row.block].table;
        scratch_->meter().of_table(table) += ns / count;
        scratch_->meter().ran(table, Phase::Constrain);
    }
}

void GroupSystem::project()
{
    if (!rows_) return;
    call_.context.time = frame_.start_time + (from_ + call_.context.dt);
    scratch_->meter().enter(scratch_->rows_ns);
    if (minimal_) rows_->forget_multipliers();
    ProjectionReport report = rows_->project(call_.context, row_book());
    keep_reactions();
    scratch_->meter().leave();
    const auto by_id = [this](std::uint32_t x, std::uint32_t y) { return frame_.world->rank(x) < frame_.world->rank(y); };
    std::sort(report.contradictory.begin(), report.contradictory.end(), by_id);
    announce_contradictions(report);
    share_cost_of_rows();
}

namespace
{

/// The remaining error of contradictory rows: of positions, or else of speeds.
std::string left_over(const ProjectionReport& report)
{
    return report.places_hold ? rounded_text(report.speed_error) + " m/s or rad/s remain"
                              : rounded_text(report.position_error) + " m or rad remain";
}

}  // namespace

void GroupSystem::announce_contradictions(const ProjectionReport& report)
{
    if (!call_.context.events) return;
    std::vector<std::uint8_t>& reported = *frame_.reported_contradictory;
    for (const std::uint32_t component : report.contradictory)
    {
        if (reported[component] != 0) continue;
        Event e;
        e.time = call_.context.time, e.kind = "constraint.contradiction", e.severity = Severity::Warning, e.component = component;
        std::string others;
        for (const std::uint32_t other : report.contradictory)
            if (other != component) others += (others.empty() ? "" : ", ") + frame_.world->id_of(other);
        e.message = "cannot hold" + (others.empty() ? std::string() : " together with " + others) + ": " + left_over(report) +
                    ", distributed by least squares";
        e.values = {report.position_error, report.speed_error};
        call_.context.events->emit(std::move(e));
    }
    for (const std::uint32_t component : joints_) reported[component] = 0;
    for (const std::uint32_t component : report.contradictory) reported[component] = 1;
}

void GroupSystem::add_reports(RowReportTable& reports) const
{
    if (rows_) rows_->report_to(reports);
}

}  // namespace plab::simulation
