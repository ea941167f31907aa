/// Determines the contents of a file that has no summary.
#pragma once

#include "idl/recording/file_index.h"

namespace plab::recording
{

/// Reads record by record from `begin`, skipping the bodies of chunks and attachments; opens chunks only where a channel occurs
/// for the first time. Ends at DataEnd, where the file is truncated, or where it is damaged, which is added to the troubles. An
/// incomplete chunk does not count.
Result<FileIndex> scan_file(const Source& source, std::uint64_t begin, const Limits& limits);

}  // namespace plab::recording
