/// Determines the positions of everything in a file.
#pragma once

#include "idl/recording/file_index.h"

namespace plab::recording
{

/// Uses the summary if there is a complete one, otherwise a scan. An error: this is not a recording, or cannot be read at all.
/// In a file without a summary, the channels of a chunk are read from records that no CRC covers: readers rely on them,
/// recover() does not.
Result<FileIndex> read_index(const Source& source, const Limits& limits);

}  // namespace plab::recording
