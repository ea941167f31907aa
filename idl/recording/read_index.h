/// Finding out where everything stands in a file.
#pragma once

#include "idl/recording/file_index.h"

namespace plab::recording
{

/// By the summary if there is a whole one, else by a scan. An error: this is no recording, or cannot be read at all.
/// In a file without a summary, which channels a chunk holds is told by records that no CRC covers: recover() does not
/// rely on them, readers do.
Result<FileIndex> read_index(const Source& source, const Limits& limits);

}  // namespace plab::recording
