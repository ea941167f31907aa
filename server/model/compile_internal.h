/// Shared by the passes of compile(). Order of the passes: compile.cpp. Private to this folder.
#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "model/blueprint.h"
#include "model/compile_limits.h"
#include "model/scene.h"
#include "model/type_registry.h"

namespace plab::model::detail
{

inline constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// Errors of all passes. The hash tables below are only used for lookups and never iterated, so their order has no effect.
class Report
{
public:
    explicit Report(std::size_t most) : most_(most) {}
    void add(const SourceLocation& where, std::string element, std::string why) { add({where, std::move(element), std::move(why)}, {}); }
    /// Reports an unknown id: similar ids are searched for only for the errors that are shown in the end.
    void add_unknown_id(const SourceLocation& where, std::string element, std::string why, std::string wanted)
    {
        add({where, std::move(element), std::move(why)}, std::move(wanted));
    }
    bool empty() const { return complaints_.empty(); }
    /// Sorted by place, limited in number; `ids` are the existing ids.
    Errors finish(const std::vector<std::string>& ids, const std::string& file);

private:
    struct Complaint
    {
        Error error;
        std::string wanted_id;
    };
    void add(Error error, std::string wanted);

    std::size_t most_;
    std::size_t dropped_ = 0;
    std::vector<Complaint> complaints_;
    std::unordered_set<std::string> seen_;  // one error per place and reason: a repetition causes it in each cell
};

using Names = std::unordered_set<std::string>;

/// One cell of a <repeat>: how its ids and positions change.
struct Cell
{
    const Names* components = nullptr;  ///< ids that the repeat defines
    const Names* commands = nullptr;
    std::string suffix;  ///< ".3.0"
    Vec3 offset;         ///< m
};

/// An id as it is in a cell; outside of repeats unchanged.
inline std::string component_id(const Cell* cell, const std::string& id)
{
    return cell && cell->components->contains(id) ? id + cell->suffix : id;
}
inline std::string command_id(const Cell* cell, const std::string& id)
{
    return cell && cell->commands->contains(id) ? id + cell->suffix : id;
}

struct Reference
{
    std::string id;
    SourceLocation where;
};

struct GivenField
{
    std::size_t index = 0;  ///< in the schema
    Value value;
    SourceLocation where;
};

struct GivenRole
{
    bool given = false;
    bool everyone = false;              ///< those that are added later take part as well
    std::vector<std::string> patterns;  ///< as in RoleSpec
    bool may_be_type = false;           ///< a single word of a short form: an id, or the type of a part to generate
    bool unresolved = false;            ///< an error was already reported
    std::vector<Reference> references;
    std::vector<std::size_t> members;  ///< drafts, in id order
    SourceLocation where;
};

/// A dotted attribute ("response.restitution"), until its part is known.
struct GivenPart
{
    std::size_t role = 0;
    std::string name;
    const TextNode* text = nullptr;
};

/// A component during compilation. Those of the existing scene come first, and can only be referred to.
struct Draft
{
    std::string id;
    std::string name;
    std::string type_name;
    const ComponentNode* node = nullptr;  ///< null if generated or existing
    const ComponentSpec* existing = nullptr;
    const ComponentType* type = nullptr;
    const Cell* cell = nullptr;
    bool broken = false;  ///< an error was already reported: suppress follow-up errors
    bool generated = false;
    bool parts_formed = false;
    std::size_t parent = kNone;
    std::vector<std::size_t> children;
    std::size_t alias = kNone;       ///< draft that it shares
    std::vector<std::size_t> group;  ///< drafts that its comprefs name
    std::vector<GivenField> fields;
    std::vector<GivenRole> roles;  ///< one per role of the schema
    std::vector<GivenPart> parts;
    bool explicit_commands = false;
    std::set<int> commands;  ///< selected, as indices of info.commands
    SourceLocation where;
};

/// A command where it is defined.
struct Command
{
    const CommandNode* node = nullptr;
    std::size_t owner = kNone;  ///< draft
    const Cell* cell = nullptr;
    bool in_stage = false;
    std::size_t anonymous = kNone;  ///< the component that it makes (the paper's figure 7)
    bool parameters_applied = false;
};

/// Finds drafts by id and by what a role accepts.
class Directory
{
public:
    std::deque<Draft> drafts;  // addresses stay while parts are added
    std::unordered_map<std::string, std::size_t> index;

    std::size_t find(const std::string& id) const;
    /// Follows aliases to the final component; kNone for a circular reference.
    std::size_t follow(std::size_t i) const;
    /// Typed components inside a group or below a component, with aliases followed, without itself; each once.
    std::vector<std::size_t> inside(std::size_t group) const;
};

struct Participants
{
    std::vector<std::size_t> members;
    std::string why;       ///< reason of a failure
    bool unknown = false;  ///< failed because the id does not exist
    bool broken = false;   ///< the component has an error that was already reported
};

/// Whether a component of this type may take this role.
bool accepts(const Role& role, const ComponentType& type);
/// "a body or a shaft", "a component of type Response/...".
std::string describe_wanted(const Role& role);
/// The components that `written` denotes in `role`.
Participants find_participants(const Directory& directory, const std::string& written, const Role& role);

/// The state of one compile().
struct Compilation
{
    Compilation(const Blueprint& b, TypeSource& t, const SceneSpec* e, const CompileLimits& l)
        : blueprint(&b), types(&t), existing(e), limits(l), report(l.errors)
    {
    }

    const Blueprint* blueprint;
    TypeSource* types;
    const SceneSpec* existing;
    CompileLimits limits;
    Report report;

    SceneSettings settings;
    SourceLocation solver_place;
    bool solver_broken = false;
    bool limit_reported = false;  ///< too many components: reported once, at the first that exceeds the limit
    Directory directory;
    std::deque<Cell> cells;
    std::deque<Names> repeated_names;
    std::vector<Command> commands;  ///< document order
    std::unordered_map<std::string, std::size_t> command_index;
    std::unordered_map<std::string, Result<const ComponentType*>> loaded;
    std::vector<std::string> type_names;  ///< sorted; requested once

    Draft& draft(std::size_t i) { return directory.drafts[i]; }
    /// "red (State/RigidBody)", for messages.
    std::string element(std::size_t i) const;
    bool is_type_name(const std::string& name);
    /// The full name of a type that may be shortened; `within`: the beginning that its name should have.
    Result<std::string> full_type_name(const std::string& written, const std::string& within = {});
    /// The type, loaded at most once.
    const Result<const ComponentType*>& require(const std::string& type);
    void complain(std::size_t i, const SourceLocation& where, std::string why) { report.add(where, element(i), std::move(why)); }
};

/// Whether `more` additional components exceed the limit; then an error is reported at `where`.
bool too_many(Compilation& c, std::size_t more, const SourceLocation& where, const std::string& element);
/// Adds a draft; registers its id, refusing empty, invalid and used ones.
std::size_t add_draft(Compilation& c, Draft draft);
/// Loads the draft's type and sizes its roles; if there is no type, reports an error and marks the draft as broken.
void bind_type(Compilation& c, std::size_t i);

/// Sets a field, a role or (dotted) a part's field; reports errors.
void give(Compilation& c, std::size_t i, const std::string& name, const TextNode& text, const Cell* cell);
/// The same for a cmdparam: "SetVelocityFactor".
void give_by_setter(Compilation& c, std::size_t i, const TextNode& text, const Cell* cell);
/// The component that a command acts on, or kNone after an error was reported.
std::size_t subject_of(Compilation& c, const Command& command);
/// The text of a <cmdref> that stands for the subject; empty if the command has none.
std::string written_subject(Compilation& c, const Command& command);
std::string command_element(const Command& command);

/// An exported command by name or unique prefix; stage: only those of that stage count for a prefix.
struct CommandMatch
{
    int index = -1;
    std::string why;
};
CommandMatch match_command(const ComponentType& type, const std::string& written, const Stage* stage);

/// Cycles of a directed graph, as paths of nodes; empty if there are none, and not all if there are many.
std::vector<std::vector<std::size_t>> find_circles(const std::vector<std::vector<std::size_t>>& edges);

// The passes, in order.
void read_settings(Compilation& c);
void declare_existing(Compilation& c);
void declare_components(Compilation& c);
void settle_solver(Compilation& c);
void link_references(Compilation& c);
void collect_commands(Compilation& c);
void gather_fields(Compilation& c);
/// Called twice: before parts are generated, for the existing subjects, and afterwards for the parts.
void apply_command_parameters(Compilation& c, bool parts_are_formed);
void form_parts(Compilation& c);
void resolve_roles(Compilation& c);
void check_roles(Compilation& c);
void finish_fields(Compilation& c);
void select_commands(Compilation& c);
SceneSpec assemble(Compilation& c);

}  // namespace plab::model::detail
