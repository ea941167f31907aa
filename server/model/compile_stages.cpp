/// Simulation commands: which exported commands of which components take part in which stage.

#include <algorithm>
#include <optional>
#include <utility>

#include "model/compile_internal.h"
#include "model/names.h"
#include "model/text.h"

namespace plab::model::detail
{

namespace
{

constexpr std::string_view kStageTypePrefix = "Stage/";
constexpr Stage kStages[] = {Stage::Init, Stage::PreStep, Stage::Step, Stage::PostStep, Stage::Rewind, Stage::Deinit};
/// A list that refers to itself twice would grow exponentially.
constexpr std::size_t kLongestList = 100'000;
constexpr std::size_t kDeepestComposite = 64;

bool is_stage(const CommandNode& node) { return node.name.starts_with(kStageTypePrefix); }

bool is_simulation(const CommandNode& node) { return std::any_of(node.children.begin(), node.children.end(), is_stage); }

/// One command of one component in a stage list.
struct Selected
{
    std::size_t component = kNone;
    int command = -1;
    const CommandNode* node = nullptr;
};

/// Reads one simulation command of the component `owner`.
class Selection
{
public:
    Selection(Compilation& c, std::size_t owner) : c_(&c), owner_(owner) {}

    void read(const CommandNode& simulation)
    {
        enter_scope();
        std::unordered_set<std::string> seen;
        for (const CommandNode& child : simulation.children)
        {
            if (!is_stage(child))
                complain(child, "a simulation command can contain only stages (Stage/Init, Stage/PreStep, ...)");
            else if (!seen.insert(child.name).second)
                complain(child, "stage " + quoted(child.name) + " is given twice");
            else if (const std::optional<Stage> stage = find_stage(child))
                read_stage(child, *stage);
        }
    }

private:
    void complain(const CommandNode& node, std::string why)
    {
        c_->report.add(node.where, command_element({&node, owner_, c_->draft(owner_).cell}), std::move(why));
    }

    /// Components inside take part only with the listed commands. Parts that the author left out keep their defaults.
    void enter_scope()
    {
        std::vector<std::size_t> open{owner_};
        while (!open.empty())
        {
            Draft& d = c_->draft(open.back());
            open.pop_back();
            if (d.generated) continue;
            d.explicit_commands = !d.type_name.empty();
            open.insert(open.end(), d.children.begin(), d.children.end());
        }
    }

    std::optional<Stage> find_stage(const CommandNode& node)
    {
        std::vector<std::string> known;
        for (const Stage stage : kStages)
        {
            known.push_back(std::string(kStageTypePrefix) + std::string(name_of(stage)));
            if (known.back() == node.name) return stage;
        }
        complain(node, "unknown stage " + quoted(node.name) + did_you_mean(node.name, known) + " (stages are " + quoted_list(known) + ")");
        return std::nullopt;
    }

    void read_stage(const CommandNode& node, Stage stage)
    {
        list_.clear();
        listed_.clear();
        items_ = 0;
        stage_ = stage;
        for (const CommandNode& child : node.children) expand(child, owner_);
        if (items_ > kLongestList) return complain(node, "the list has more than 100000 commands");
        check_order();
        for (const Selected& s : list_)
        {
            Draft& d = c_->draft(s.component);
            d.explicit_commands = true;
            d.commands.insert(s.command);
        }
    }

    /// Appends the commands that a list item denotes.
    void expand(const CommandNode& node, std::size_t owner)
    {
        if (++items_ > kLongestList) return;
        if (!node.reference.empty()) return expand_reference(node, owner);
        if (!node.type.empty()) return select(node, owner);
        if (is_stage(node) || is_simulation(node)) return complain(node, "a stage can only be part of a simulation command");
        if (path_.size() >= kDeepestComposite) return complain(node, "composites are nested deeper than 64");
        if (std::find(path_.begin(), path_.end(), &node) != path_.end()) return complain_circle(node);
        path_.push_back(&node);
        for (const CommandNode& child : node.children) expand(child, owner);
        path_.pop_back();
    }

    void expand_reference(const CommandNode& node, std::size_t owner)
    {
        const std::string id = command_id(c_->draft(owner).cell, node.reference);
        const auto it = c_->command_index.find(id);
        if (it == c_->command_index.end()) return complain(node, "cmdref: no command has the id " + quoted(id));
        const Command& target = c_->commands[it->second];
        expand(*target.node, target.owner);
    }

    void complain_circle(const CommandNode& node)
    {
        std::string text;
        for (auto it = std::find(path_.begin(), path_.end(), &node); it != path_.end(); ++it)
            text += quoted((*it)->id.empty() ? (*it)->name : (*it)->id) + " -> ";
        complain(node, "circular reference of commands: " + text + quoted(node.id.empty() ? node.name : node.id));
    }

    void select(const CommandNode& node, std::size_t owner)
    {
        Command command{&node, owner, c_->draft(owner).cell, true, kNone};
        command.anonymous = find_anonymous(node, owner);
        const std::size_t i = subject_of(*c_, command);
        if (i == kNone || !c_->draft(i).type) return;
        if (c_->draft(i).existing)
            return complain(node, "subject " + quoted(c_->draft(i).id) + " is already in the running scene: it keeps its commands");
        if (command.anonymous != kNone) return select_all(node, i);
        const CommandMatch match = match_command(*c_->draft(i).type, node.type, &stage_);
        if (match.index < 0) return complain(node, match.why);
        const CommandInfo& info = c_->draft(i).type->info.commands[static_cast<std::size_t>(match.index)];
        if (stage_of(info.phase) != stage_) return complain(node, wrong_stage(info));
        if (!listed_.emplace(i, match.index).second)
            return complain(node, quoted(info.name) + " of " + quoted(c_->draft(i).id) + " is in the list twice");
        list_.push_back({i, match.index, &node});
    }

    std::size_t find_anonymous(const CommandNode& node, std::size_t owner) const
    {
        if (!node.subject.empty() || node.id.empty()) return kNone;
        const std::size_t i = c_->directory.find(command_id(c_->draft(owner).cell, node.id));
        const bool made = i != kNone && c_->draft(i).generated && c_->draft(i).parent == owner && c_->draft(i).type_name == node.type;
        return made ? i : kNone;
    }

    /// A component made by a command takes part with its commands of that stage, and with those that prepare it.
    void select_all(const CommandNode& node, std::size_t i)
    {
        const std::vector<CommandInfo>& commands = c_->draft(i).type->info.commands;
        std::vector<Selected> found;
        for (std::size_t k = 0; k < commands.size(); ++k)
            if (stage_of(commands[k].phase) == stage_) found.push_back({i, static_cast<int>(k), &node});
        if (found.empty()) return complain(node, "does no work in Stage/" + std::string(name_of(stage_)));
        std::stable_sort(found.begin(), found.end(), [&](const Selected& a, const Selected& b) { return phase(a) < phase(b); });
        list_.insert(list_.end(), found.begin(), found.end());
        for (std::size_t k = 0; k < commands.size(); ++k)
            if (stage_of(commands[k].phase) == Stage::Init) c_->draft(i).commands.insert(static_cast<int>(k));
    }

    std::string wrong_stage(const CommandInfo& info) const
    {
        return quoted(info.name) + " belongs to Stage/" + std::string(name_of(stage_of(info.phase))) + ", not to Stage/" +
               std::string(name_of(stage_)) + ": the step runs it in its phase " + quoted(name_of(info.phase));
    }

    Phase phase(const Selected& s) const { return c_->draft(s.component).type->info.commands[static_cast<std::size_t>(s.command)].phase; }

    /// The step runs phases in one fixed order; a list in a different order would promise something that does not happen.
    void check_order()
    {
        for (std::size_t k = 1; k < list_.size(); ++k)
        {
            const Selected &before = list_[k - 1], &after = list_[k];
            if (phase(before) <= phase(after)) continue;
            complain(*after.node, "comes after " + quoted(before.node->type) + " (phase " + quoted(name_of(phase(before))) +
                                      "), but the step runs its phase " + quoted(name_of(phase(after))) + " first: put it before");
        }
    }

    Compilation* c_;
    std::size_t owner_;
    Stage stage_ = Stage::Init;
    std::vector<Selected> list_;
    std::set<std::pair<std::size_t, int>> listed_;  // components with their commands
    std::size_t items_ = 0;                         // number of items processed, including refused ones
    std::vector<const CommandNode*> path_;          // composites being expanded
};

/// A command outside of stage lists is only exported, but what it exports must exist.
void check_export(Compilation& c, const Command& command)
{
    const CommandNode& node = *command.node;
    if (node.type.empty() || command.in_stage || command.anonymous != kNone || !node.children.empty()) return;
    const std::size_t i = subject_of(c, command);
    if (i == kNone || !c.draft(i).type) return;
    const CommandMatch match = match_command(*c.draft(i).type, node.type, nullptr);
    if (match.index < 0) c.report.add(node.where, command_element(command), match.why);
}

void check_references(Compilation& c, const Command& command)
{
    const CommandNode& node = *command.node;
    if (node.reference.empty() || command.in_stage) return;
    const std::string id = command_id(command.cell, node.reference);
    if (!c.command_index.contains(id)) c.report.add(node.where, command_element(command), "cmdref: no command has the id " + quoted(id));
}

}  // namespace

void select_commands(Compilation& c)
{
    for (std::size_t i = 0; i < c.directory.drafts.size(); ++i)
    {
        const ComponentNode* node = c.draft(i).node;
        if (!node) continue;
        const CommandNode* first = nullptr;
        for (const CommandNode& command : node->commands)
        {
            if (!is_simulation(command)) continue;
            if (first)
                c.report.add(command.where, command_element({&command, i, c.draft(i).cell}),
                             "a component can have only one simulation command, which is already " + quoted(first->name));
            else
                Selection(c, i).read(command);
            first = &command;
        }
    }
    for (const Command& command : c.commands)
    {
        check_export(c, command);
        check_references(c, command);
    }
}

}  // namespace plab::model::detail
