/// The format of our recordings: what topics and metadata of a file mean, beyond MCAP. Every reader of ours opens files here.
#pragma once

#include "idl/recording/reader.h"

namespace plab::recording
{

/// Counted up when files of this build mean something that older builds would misread.
inline constexpr int kFormat = 1;
/// The metadata record that tells it, under the key "format", with the file's origin.
inline constexpr const char* kAbout = "plab";

/// As Reader::open(), and refused is what is of a newer format, or of one that nobody knows. A file without our metadata (others'
/// tools make such, or its beginning was lost) is taken as it is.
Result<Reader> open_recording(const std::string& path);

}  // namespace plab::recording
