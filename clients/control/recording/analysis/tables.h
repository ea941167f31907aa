/// The topics of a recording as tables: one for each topic that has one, one row per sample and entry.
/// Column names include the unit: "position_x_m", "speed_rad_per_s"; columns without one are pure numbers or text. All tables
/// begin with run, step, time_s (simulated), log_time_s (the recording's own time line). A cell is empty if there is no value.
#pragma once

#include <span>
#include <string_view>

#include "control/recording/analysis/contents.h"
#include "plab/csv.h"

namespace plab::analysis
{

struct Table
{
    std::string_view topic;
    std::string_view columns;  ///< after the four that all tables have
    void (*add_rows)(const Entry& entry, const Things& things, CsvRow& rows);
};

std::span<const Table> tables();
/// Null: this topic has none.
const Table* find_table(std::string_view topic);
/// The first line, with its end.
std::string head_of(const Table& table);

}  // namespace plab::analysis
