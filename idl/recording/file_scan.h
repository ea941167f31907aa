/// Finding out what stands in a file that has no summary.
#pragma once

#include "idl/recording/file_index.h"

namespace plab::recording
{

/// Reads record by record from `begin` on, skipping the bodies of chunks and attachments; takes chunks apart only where a
/// channel shows up for the first time. Ends at DataEnd, or where the file is cut, or where it is damaged: that is one
/// of the troubles. A chunk that is not all there does not count.
Result<FileIndex> scan_file(const Source& source, std::uint64_t begin, const Limits& limits);

}  // namespace plab::recording
