/// The format of our recordings: what topics and metadata of a file mean, beyond MCAP. Every reader of ours opens files here.
#pragma once

#include "idl/recording/reader.h"

namespace plab::recording
{

/// Counted up when files of this build mean something that older builds would misread. Format 1 had the types of plab::v1.
inline constexpr int kFormat = 2;
/// Files before this one are refused: their types are not those of plab.idl.
inline constexpr int kOldestFormat = 2;
/// The metadata record that tells it, under the key "format", with the file's origin.
inline constexpr const char* kAbout = "plab";

/// As Reader::open(), and refused is what is of a newer or an outdated format, or of one that nobody knows. A file without our metadata
/// (others' tools make such, or its beginning was lost) is taken as it is.
Result<Reader> open_recording(const std::string& path, const Watch& watch = {});

}  // namespace plab::recording
