/// Scenes of other programs (URDF, SDF, MJCF) as blueprints. server/docs/importing.md states what is carried over and what is listed.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plab/result.h"
#include "plab/vector.h"

namespace plab::import
{

/// Of a scene that is there already: a group of this name, whose components have ids that begin with it, without the things that a scene
/// has once: settings, gravity and contacts.
struct Part
{
    std::string name;
    Pose place;  ///< of the file's world in that scene
};

struct ImportOptions
{
    bool fixed_base = false;           ///< bodies that hang on nothing do not move
    std::vector<std::string> folders;  ///< in which SDF's model://NAME is looked for, beside the folders above the file
    std::optional<Part> part{};
    bool self_collide = false;  ///< of URDF: links of the robot collide with one another, but for those that a joint joins
};

struct ImportedScene
{
    std::string blueprint;  ///< XML
    std::string root;       ///< id of the first body
    Errors losses;          ///< what could not be carried over: place, element, reason
    std::size_t bodies = 0, joints = 0;
};

enum class SceneFormat
{
    Blueprint,
    Urdf,
    Sdf,
    Mjcf,
};

/// By the file's name (.urdf, .sdf, .world, .mjcf), else by its first element (<robot>, <sdf>, <mujoco>). Files that cannot be read count
/// as blueprints.
SceneFormat format_of_file(const std::string& path);
/// The name of the first element of an XML text; "" if there is none in its first 64 kB.
std::string_view first_element(std::string_view text);

/// Never throws, whatever the file contains. Errors name file, line and column.
Result<ImportedScene> import_file(const std::string& path, const ImportOptions& options);
/// `file` is for messages and for finding meshes.
Result<ImportedScene> import_text(std::string_view text, const std::string& file, SceneFormat format, const ImportOptions& options);

}  // namespace plab::import
