/// Manifests: which types a plugin has, told without loading it.
///
///   plab-manifest 1
///   Field/Gravity
///   Field/Drag
///
/// "fields.manifest" speaks for "fields.so" in the same folder.
#pragma once

#include <string>
#include <vector>

#include "plab/result.h"

namespace plab::plugins
{

inline constexpr std::string_view kManifestHeader = "plab-manifest 1";

struct Manifest
{
    std::string path;                ///< of the manifest
    std::string plugin;              ///< path of the library
    std::vector<std::string> types;  ///< sorted
};

Result<Manifest> read_manifest(const std::string& path);

/// Writes beside `path` and renames, so that a reader sees the old manifest or the new one, never a part.
Result<void> write_manifest(const std::string& path, std::vector<std::string> types);

/// All manifests of a folder, by file name. What is wrong with single ones goes to `problems`.
std::vector<Manifest> find_manifests(const std::string& directory, Errors& problems);

}  // namespace plab::plugins
