/// A small world of types for tests of the compiler, and short words for hand-made blueprint trees.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/compile.h"

namespace plab::test
{

/// Types that are registered by register_types(), each "loaded" when it is asked for.
class FixedTypes final : public model::TypeSource
{
public:
    FixedTypes();
    Result<const model::ComponentType*> require(const std::string& name) override;
    std::vector<std::string> names() const override;

    std::vector<std::string> asked;  ///< in the order of the first question

private:
    model::TypeRegistry registry_;
};

/// The nodes of a tree; every node is in "scene.xml", its line is given or 0.
using Texts = std::vector<std::pair<std::string, std::string>>;

SourceLocation at(std::uint32_t line, std::uint32_t column = 1);
model::TextNode text(std::string name, std::string value, std::uint32_t line = 0);
model::TextNode reference(std::string name, std::vector<std::string> components, std::uint32_t line = 0);
model::TextNode command_reference(std::string name, std::vector<std::string> commands, std::uint32_t line = 0);
model::ComponentNode component(std::string id, std::string type, const Texts& attributes = {}, std::uint32_t line = 0);
model::ComponentNode group(std::string id, std::vector<model::ComponentNode> children, std::uint32_t line = 0);
/// <component id><compref>..</compref></component>.
model::ComponentNode shares(std::string id, std::vector<std::string> ids, std::uint32_t line = 0);
model::CommandNode command(std::string subject, std::string type, std::uint32_t line = 0);
model::CommandNode composite(std::string id, std::string name, std::vector<model::CommandNode> children, std::uint32_t line = 0);
model::CommandNode see_command(std::string id, std::uint32_t line = 0);
model::RepeatNode repeat(const Texts& attributes, std::vector<model::ComponentNode> components, std::uint32_t line = 0);
/// A rigid body of 1 kg in line 5, and a shaft.
model::ComponentNode body(const std::string& id, Texts more = {});
model::ComponentNode shaft(const std::string& id);
model::Blueprint scene(std::vector<model::ComponentNode> components);

/// The compiled scene; a failure is a failed test that shows the errors.
model::SceneSpec compiled(const model::Blueprint& blueprint, const model::SceneSpec* existing = nullptr);
/// The errors, one per line; empty if there are none.
std::string errors_of(const model::Blueprint& blueprint, const model::SceneSpec* existing = nullptr);
std::string errors_of(std::vector<model::ComponentNode> components);

/// A component's role, as "a b c"; "*" in front if it means everyone; "-" if it is not given.
std::string role_of(const model::SceneSpec& scene, const std::string& id, const std::string& role);
/// A component's field as text; "-" if it is not given.
std::string field_of(const model::SceneSpec& scene, const std::string& id, const std::string& field);
/// All ids in order, as "a b c".
std::string ids_of(const model::SceneSpec& scene);
/// Selected commands, as "a b c"; "defaults" where none are selected.
std::string commands_of(const model::SceneSpec& scene, const std::string& id);
/// The whole content of a scene as text, to compare two.
std::string dump(const model::SceneSpec& scene);

}  // namespace plab::test
