/// Commands: where they are defined, on which components they act, and the parameters that they set.

#include <algorithm>

#include "model/compile_internal.h"
#include "model/names.h"
#include "model/text.h"

namespace plab::model::detail
{

namespace
{

constexpr std::string_view kStagePrefix = "Stage/";

/// Figure 7 of the paper: a command with a component's type and without a subject is itself that component, unnamed.
bool makes_component(Compilation& c, const Command& command)
{
    const CommandNode& node = *command.node;
    if (node.type.empty() || !node.subject.empty() || !node.reference.empty() || !node.children.empty()) return false;
    const Draft& owner = c.draft(command.owner);
    return !(owner.type && owner.type->find_command(node.type) >= 0) && c.is_type_name(node.type);
}

void make_anonymous(Compilation& c, Command& command)
{
    Draft d;
    d.id = command_id(command.cell, command.node->id);
    d.name = command.node->name;
    d.type_name = command.node->type;
    d.cell = command.cell;
    d.generated = true;
    d.parent = command.owner;
    d.where = command.node->where;
    command.anonymous = add_draft(c, std::move(d));
    bind_type(c, command.anonymous);
}

/// Restrictions on a command that do not depend on what it refers to.
std::string why_malformed(const CommandNode& node, bool is_stage)
{
    if (!node.reference.empty()) return {};
    if (is_stage && !(node.type.empty() && node.subject.empty())) return "a stage has neither type nor subject";
    if (is_stage) return node.parameters.empty() ? std::string() : "a cmdparam does not follow a command";
    if (node.type.empty() && node.children.empty()) return "needs a type, or commands in it";
    if (node.type.empty() && !node.subject.empty()) return "a composite has no subject: its parts have one each";
    if (node.type.empty() && !node.parameters.empty()) return "a composite has no parameters: set them on the subjects of its parts";
    if (!node.type.empty() && !node.children.empty()) return "has a type, so it cannot have commands in it";
    return {};
}

void collect(Compilation& c, const CommandNode& node, std::size_t owner, bool in_stage)
{
    const bool is_stage = node.name.starts_with(kStagePrefix);
    Command command{&node, owner, c.draft(owner).cell, in_stage, kNone};
    if (const std::string why = why_malformed(node, is_stage); !why.empty())
        c.report.add(node.where, command_element(command), why);
    else if (makes_component(c, command))
        make_anonymous(c, command);
    const std::string id = command_id(command.cell, node.id);
    if (!id.empty())
    {
        const auto [it, fresh] = c.command_index.emplace(id, c.commands.size());
        if (!fresh)
            c.report.add(node.where, command_element(command),
                         "command id " + quoted(node.id) + " is already used at " + place_text(c.commands[it->second].node->where));
    }
    c.commands.push_back(command);
    for (const CommandNode& child : node.children) collect(c, child, owner, in_stage || is_stage);
}

/// The only component inside a group that exports the command; kNone after an error was reported.
std::size_t subject_inside(Compilation& c, const Command& command, std::size_t group)
{
    std::vector<std::size_t> found;
    for (const std::size_t i : c.directory.inside(group))
    {
        if (c.draft(i).broken) return kNone;
        if (c.draft(i).type && match_command(*c.draft(i).type, command.node->type, nullptr).index >= 0) found.push_back(i);
    }
    if (found.size() == 1) return found.front();
    std::vector<std::string> ids;
    for (const std::size_t i : found) ids.push_back(c.draft(i).id);
    std::sort(ids.begin(), ids.end());
    const std::string subject = "subject " + quoted(c.draft(group).id);
    c.report.add(command.node->where, command_element(command),
                 found.empty() ? subject + " holds no component with a command " + quoted(command.node->type)
                               : subject + " holds several components with that command (" + quoted_list(ids) + "): name one of them");
    return kNone;
}

/// Its subject exists already; the subjects that short forms generate come later.
bool can_be_applied(Compilation& c, const Command& command)
{
    return command.node->subject.empty() || c.directory.find(component_id(command.cell, command.node->subject)) != kNone;
}

void apply_parameters(Compilation& c, const Command& command)
{
    const std::size_t i = subject_of(c, command);
    if (i == kNone || !c.draft(i).type) return;
    if (c.draft(i).existing)
        return c.report.add(command.node->where, command_element(command),
                            "subject " + quoted(c.draft(i).id) + " is already in the running scene: set its parameters by a request");
    for (const TextNode& text : command.node->parameters) give_by_setter(c, i, text, command.cell);
}

}  // namespace

std::string command_element(const Command& command)
{
    const CommandNode& node = *command.node;
    const std::string id = command_id(command.cell, node.id);
    const std::string what = node.type.empty() ? node.name : node.type;
    std::string out = "command";
    if (!id.empty()) out += " " + id;
    if (!what.empty()) out += id.empty() ? " " + what : " (" + what + ")";
    return out;
}

CommandMatch match_command(const ComponentType& type, const std::string& written, const Stage* stage)
{
    CommandMatch out;
    out.index = type.find_command(written);
    if (out.index >= 0) return out;
    std::vector<std::string> known, fitting;
    for (std::size_t k = 0; k < type.info.commands.size(); ++k)
    {
        const CommandInfo& info = type.info.commands[k];
        known.push_back(info.name);
        if (!info.name.starts_with(written + "/") || (stage && stage_of(info.phase) != *stage)) continue;
        fitting.push_back(info.name);
        out.index = static_cast<int>(k);
    }
    if (fitting.size() == 1) return out;
    out.index = -1;
    if (!fitting.empty())
        out.why = quoted(written) + " could be " + quoted_list(fitting, "or") + ": name one of them";
    else if (known.empty())
        out.why = type.info.name + " has no commands";
    else
        out.why =
            type.info.name + " has no command " + quoted(written) + did_you_mean(written, known) + " (it has " + quoted_list(known) + ")";
    return out;
}

std::size_t subject_of(Compilation& c, const Command& command)
{
    if (command.anonymous != kNone) return command.anonymous;
    const CommandNode& node = *command.node;
    if (node.subject.empty())
    {
        if (c.draft(command.owner).broken) return kNone;
        if (c.draft(command.owner).type) return command.owner;
        c.report.add(node.where, command_element(command), "needs a subject: the id of the component that it acts on");
        return kNone;
    }
    const std::string id = component_id(command.cell, node.subject);
    const std::size_t found = c.directory.find(id);
    if (found == kNone)
    {
        c.report.add_unknown_id(node.where, command_element(command), "subject: no component has the id " + quoted(id), id);
        return kNone;
    }
    const std::size_t i = c.directory.follow(found);
    if (i == kNone || c.draft(i).broken) return kNone;
    return c.draft(i).type_name.empty() ? subject_inside(c, command, i) : i;
}

std::string written_subject(Compilation& c, const Command& command)
{
    if (command.anonymous != kNone) return c.draft(command.anonymous).id;
    if (!command.node->subject.empty()) return component_id(command.cell, command.node->subject);
    return command.node->type.empty() ? std::string() : c.draft(command.owner).id;
}

void collect_commands(Compilation& c)
{
    const std::size_t written = c.directory.drafts.size();  // anonymous ones are appended
    for (std::size_t i = 0; i < written; ++i)
        if (const ComponentNode* node = c.draft(i).node)
            for (const CommandNode& command : node->commands) collect(c, command, i, false);
}

void apply_command_parameters(Compilation& c, bool parts_are_formed)
{
    for (Command& command : c.commands)
    {
        if (command.node->parameters.empty() || command.node->type.empty() || command.parameters_applied) continue;
        if (!parts_are_formed && !can_be_applied(c, command)) continue;
        command.parameters_applied = true;
        apply_parameters(c, command);
    }
}

}  // namespace plab::model::detail
