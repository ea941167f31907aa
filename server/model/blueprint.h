/// The blueprint tree: what an author wrote, with the place of each word. It knows neither XML nor time; the reader in
/// server/blueprint builds it, compile() in compile.h converts it to a SceneSpec.
#pragma once

#include <string>
#include <vector>

#include "plab/result.h"
#include "plab/value.h"

namespace plab::model
{

/// A named text: an attribute, a <param>, or a <cmdparam>'s <udata>. `references` holds ids given by <compref>/<cmdref>.
struct TextNode
{
    std::string name;
    std::string text;
    std::vector<std::string> component_references;
    std::vector<std::string> command_references;
    Entries entries;  ///< from nested <entry name=".." >value</entry>
    SourceLocation where;
};

/// A value that a foreign-XML handler made (XGL: vertices, triangles).
struct ValueNode
{
    std::string name;
    Value value;
    SourceLocation where;
};

/// <command id name subject type>: exported command, composite, or (children named Stage/...) simulation command.
struct CommandNode
{
    std::string id, name, subject, type;
    std::string reference;             ///< <cmdref> on its own in a list: the command with this id
    std::vector<TextNode> parameters;  ///< <cmdparam>, names as written ("SetVelocityFactor")
    std::vector<CommandNode> children;
    SourceLocation where;
};

/// <component id name type>: typed, or a group (an object, an interaction).
struct ComponentNode
{
    std::string id, name, type;
    std::vector<TextNode> attributes;     ///< short form: all attributes but id, name, type
    std::vector<TextNode> parameters;     ///< <param>
    std::vector<ValueNode> values;        ///< from foreign XML
    std::vector<std::string> references;  ///< <compref>: the component is the one referred to, or, if there are several, a group of them
    std::vector<SourceLocation> reference_places;
    std::vector<ComponentNode> children;
    std::vector<CommandNode> commands;
    SourceLocation where;
};

/// <repeat>: its components once per cell of a grid; see server/docs/blueprint.md.
struct RepeatNode
{
    std::vector<TextNode> attributes;
    std::vector<ComponentNode> components;
    SourceLocation where;
};

struct Blueprint
{
    std::string file;
    std::vector<TextNode> settings;      ///< attributes of <scene>
    std::vector<ComponentNode> cameras;  ///< <camera id position look_at ..> inside <scene>
    std::vector<ComponentNode> components;
    std::vector<RepeatNode> repeats;
    SourceLocation where;
};

}  // namespace plab::model
