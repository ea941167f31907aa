/// Manifests: which types a plugin has and what they declare, known without loading it.
///
///   plab-manifest 3
///   plugin  fields
///   type    Field/Gravity  Field  0  uniform gravity  ...      name, family, order, doc, accuracy, strengths, cost, limits, source
///   role    between  body  1  4294967295  bodies that ...      name, accepts, least, most, doc
///   field   gravity  param  vector  m/s^2  0 0 -9.81  ...      name, kind, value type, unit, default, required, rule, doc
///
/// Cells are separated by tabs; in a cell "\\" is a backslash and "\x09" the character of that code. Roles and fields belong
/// to the type above them. "fields.manifest" speaks for "fields.so" in the same folder.
#pragma once

#include <string>
#include <vector>

#include "model/type_summary.h"
#include "plab/result.h"

namespace plab::plugins
{

inline constexpr std::string_view kManifestHeader = "plab-manifest 3";

struct Manifest
{
    std::string path;                           ///< of the manifest
    std::string plugin;                         ///< path of the library
    std::vector<std::string> types;             ///< sorted
    std::vector<model::TypeSummary> summaries;  ///< of the same types; not loaded
};

Result<Manifest> read_manifest(const std::string& path);

/// Writes a temporary file beside `path` and renames it, so that a reader sees the old manifest or the new one, never a part.
Result<void> write_manifest(const std::string& path, const std::string& plugin, std::vector<model::TypeSummary> types);

/// All manifests of a folder, by file name. Errors in single ones go to `problems`.
std::vector<Manifest> find_manifests(const std::string& directory, Errors& problems);

}  // namespace plab::plugins
