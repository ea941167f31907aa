/// Recordings for other programs: tables (CSV) and lines of JSON.
#pragma once

#include "control/recording/analysis/log.h"

namespace plab::analysis
{

struct ExportOptions
{
    std::vector<std::string> topics = {};  ///< none: see below
    Span span = {};
    std::string out = {};  ///< "": standard output; a file; for CSV also a folder (an existing one, or a path that ends with '/')
};

struct Exported
{
    std::map<std::string, std::uint64_t> messages;  ///< by topic
    std::vector<std::string> files;                 ///< that were written
    Troubles troubles;
};

/// Writes a table (tables.h) to one file; several only to a folder, as "states.csv" and so on. Without topics: states to one
/// file, or all topics that have a table to a folder.
Result<Exported> export_csv(const Log& log, const ExportOptions& options);

/// One line per message: {"topic", "log_time" (ns), "publish_time" (ns since 1970), "message"}, all members by their names in
/// plab.idl; messages of other types than those of this version of the wire count as trouble. Without topics: all but plab/images and
/// plab/snapshots, which are large and useless as text.
Result<Exported> export_json(const Log& log, const ExportOptions& options);

}  // namespace plab::analysis
