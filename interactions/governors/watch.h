/// What all governors have: which components they watch, their ladder, and how often a level may change.
#pragma once

#include <string>

#include "plab/levels.h"
#include "plab/registrar.h"

namespace plab::governors
{

struct WatchRows
{
    Column<std::string> watches;  ///< patterns of ids
    Column<std::string> levels;   ///< ladder, cheapest first
    Column<double> every, dwell;  ///< s
    Column<double> hysteresis;    ///< fraction
    Column<Entries> changed;      ///< s: when a component was changed, by id; only of the last `dwell`
    Column<Reals> count;          ///< number of components at each level
    Column<std::int64_t> changes;

    void describe(Schema& schema);
};

/// Whether the boundary at the start of the coming step is one at which the governor looks: the first one at or after each multiple of
/// `every`.
bool due(const StepContext& context, double every);

/// One look of a governor: chooses levels within the rule that all governors share. A component gets a finer level at once, and a cheaper
/// one only when it has kept its level for `dwell`.
class Look
{
public:
    Look(const StepContext& context, Row row, WatchRows& rows, LevelControl& control);
    ~Look();
    Look(const Look&) = delete;
    Look& operator=(const Look&) = delete;

    std::span<const GovernedComponent> watched() const { return watched_; }
    std::int32_t finest() const { return finest_; }
    /// Whether choose() would change something: before a reason is written.
    bool may_choose(std::size_t index, std::int32_t level) const
    {
        const std::int32_t now = watched_[index].level;
        return level > now || (level < now && rested(index));
    }
    /// Whether the component may become cheaper now.
    bool rested(std::size_t index) const;
    /// Changes the level, unless it is that level already. Returns whether it does. `urgent`: also to a cheaper one within `dwell`.
    bool choose(std::size_t index, std::int32_t level, std::string reason, bool urgent = false);

private:
    double since(std::size_t index) const;

    const StepContext& context_;
    Row row_;
    WatchRows& rows_;
    LevelControl& control_;
    std::span<const GovernedComponent> watched_;
    std::int32_t finest_ = 0;
    Entries fresh_;  ///< changes of this look
};

/// "12.3": three significant digits, for reasons.
std::string brief(double value);

}  // namespace plab::governors
