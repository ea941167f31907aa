/// Scenes and parts of scenes that a service gets: what they are, and how a part gets its name and its place.
#pragma once

#include <functional>
#include <string>

#include "plab/result.h"
#include "plab/vector.h"
#include "ros/messages.h"

namespace plab::ros
{

/// Of another program (URDF, MJCF), to be converted.
struct ForeignScene
{
    std::string text;
    std::string format;  ///< "urdf", "mjcf"
    std::string file;    ///< for messages, and to find meshes
    std::string name;    ///< of the group that its components are put into, and the beginning of their ids; "": it is a whole scene
    Pose place;          ///< of its root in the world
};
struct ConvertedScene
{
    std::string blueprint;  ///< XML
    std::string root;       ///< id of its first body
    Errors losses;          ///< what could not be carried over
};
/// The program that has the bridge supplies it, because clients know nothing of scenes.
using Converter = std::function<Result<ConvertedScene>(const ForeignScene&)>;

struct ReadResource
{
    std::string text;
    std::string format;  ///< "plab", "urdf", "mjcf", "": another one
    std::string file;    ///< "" if it came as a text
};
/// Reads a resource: its text, or the file that its URI names (file:///PATH or /PATH), at most 4 MiB. Errors: neither is given (then with
/// an empty reason), or the file cannot be read.
Result<ReadResource> read_resource(const simulation_interfaces_msg_dds__Resource_& resource);

/// Gives the <component> with which a blueprint's text begins another id, and a place; what it had is replaced. Errors: it begins with
/// something else, or is a group, which has no place.
Result<std::string> with_name_and_place(const std::string& blueprint, const std::string& id, const Pose& place);
/// The attribute of the first element; "" if it has none.
std::string first_attribute(const std::string& xml, const std::string& name);
/// The name of the first element.
std::string first_element(const std::string& xml);

}  // namespace plab::ros
