/// The format of our recordings: the meaning of a file's topics and metadata, beyond MCAP. All our readers open files through
/// this header.
#pragma once

#include "idl/recording/reader.h"

namespace plab::recording
{

/// Incremented when files of this build mean something that older builds would misread. Format 1 had the types of plab::v1.
inline constexpr int kFormat = 2;
/// Older files are refused: their types are not those of plab.idl.
inline constexpr int kOldestFormat = 2;
/// The metadata record that contains it, under the key "format", together with the file's origin.
inline constexpr const char* kAbout = "plab";

/// What a file states about its origin.
struct Origin
{
    std::string recorder;  ///< the program
    std::string server, version, build, host, scene_file;
    std::int64_t started_ns = 0;  ///< since 1970: when the server began
    double dt = 0;                ///< s
    std::uint32_t threads = 1;
    double state_interval = 0;        ///< s, simulated, between frames; 0: each step
    bool moved_only = false;          ///< frames contain only what moved since the last one
    std::vector<std::string> topics;  ///< none: all but images and contacts
};
Metadata about(const Origin& origin);

/// Like McapReader::open(), but refuses files of a newer, an outdated or an unknown format. A file without our metadata (made by
/// another tool, or its beginning was lost) is accepted.
Result<McapReader> open_recording(const std::string& path, const Watch& watch = {});

}  // namespace plab::recording
