/// The topics of a recording as tables: one for each topic that has one, a row per sample and thing.
///
/// Columns name their unit: "position_x_m", "speed_rad_per_s"; what has none is pure or text. All tables begin with
/// run, step, time_s (simulated), log_time_s (the recording's own time line). A cell is empty where there is nothing to say.
#pragma once

#include <span>
#include <string_view>

#include "recordings/csv.h"
#include "recordings/things.h"

namespace plab::recordings
{

struct Table
{
    std::string_view topic;
    std::string_view columns;  ///< behind the four that all have
    void (*add_rows)(const Entry& entry, const Things& things, CsvRow& rows);
};

std::span<const Table> tables();
/// Null: this topic has none.
const Table* find_table(std::string_view topic);
/// The first line, with its end.
std::string head_of(const Table& table);

}  // namespace plab::recordings
