/// Recordings for other programs: tables (CSV) and lines of JSON.
#pragma once

#include "recordings/log.h"

namespace plab::recordings
{

struct ExportOptions
{
    std::vector<std::string> topics = {};  ///< none: see below
    Span span = {};
    std::string out = {};  ///< "": standard output; a file; of CSV also a folder (it is there, or ends with '/')
};

struct Exported
{
    std::map<std::string, std::uint64_t> messages;  ///< by topic
    std::vector<std::string> files;                 ///< that were written
    Troubles troubles;
};

/// A table (tables.h) into one file; several only into a folder, as "states.csv" and so on. Without topics: states into
/// one file, all that have a table into a folder.
Result<Exported> export_csv(const Log& log, const ExportOptions& options);

/// A line per message: {"topic", "log_time" (ns), "publish_time" (ns since 1970), "message"}, decoded by the schemas of the
/// file itself. Without topics: all but plab/images and plab/snapshots, which are large and of no use as text.
Result<Exported> export_json(const Log& log, const ExportOptions& options);

}  // namespace plab::recordings
