/// The types under test, each with a scene that gives it its participants.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "support/scene.h"

namespace plab::test
{

/// What is tested: all plugins of this build, or one that was built elsewhere.
struct Target
{
    std::string plugin;                      ///< file of the only one; "": all
    std::vector<std::string> scene_folders;  ///< the first that has a scene for a type wins
};
/// To be changed before anything else is asked for.
Target& target();
bool tests_all_plugins();
/// Files of the plugins that are tested, and the types in them, by name.
const std::vector<std::string>& tested_plugins();
const std::vector<std::string>& tested_types();
bool is_tested(const std::string& type);

/// The component of the type under test has this id in its scene.
inline constexpr const char* kSubject = "subject";

struct Subject
{
    std::string type;
    model::Blueprint blueprint;

    /// Whether the scene may stand several times side by side (README.md).
    bool repeatable() const;
};

/// All tested types that have a scene, by name.
const std::vector<Subject>& subjects();
/// What keeps types from being tested: a missing scene, one that cannot be read. Empty if all is well.
const std::vector<std::string>& subjects_missing();

/// The component under test in a blueprint.
model::ComponentNode& subject_node(model::Blueprint& blueprint);
/// The scene with one field of the subject written anew.
model::Blueprint with_field(const model::Blueprint& scene, const std::string& name, const std::string& text);
/// What the subject's type declares.
const Schema& schema_of(const Subject& subject);
/// Whether a blueprint may give it.
bool settable(const Field& field);
/// How many real numbers a text of this type has, a list at least one; 0: it is not made of them.
int count_of_reals(FieldType type);
/// The same scene four times, 100 m apart.
model::Blueprint repeated(const Subject& subject);

/// The scene compiled; a scene that does not compile fails the test.
model::SceneSpec compiled(const model::Blueprint& blueprint, model::TypeSource& types = library());
/// The scene loaded; one that does not load fails the test.
std::unique_ptr<simulation::Simulation> started(const model::SceneSpec& scene, int threads = 1, model::TypeSource& types = library());
/// Hash after each of `steps` steps.
std::vector<std::uint64_t> hashes(simulation::Simulation& simulation, int steps);
/// The first step at which two runs differ, or -1.
int first_difference(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b);

}  // namespace plab::test
