/// Declares the components: ids, types, nesting, comprefs.

#include <algorithm>
#include <limits>
#include <utility>

#include "model/compile_internal.h"
#include "model/repeat.h"
#include "model/text.h"
#include "model/values.h"

namespace plab::model::detail
{

namespace
{

constexpr std::size_t kLongestId = 200;

/// Why `id` cannot be used; empty if it can.
std::string why_no_id(const std::string& id)
{
    if (trimmed(id).empty()) return "needs an id";
    if (id.size() > kLongestId) return "has an id of " + std::to_string(id.size()) + " characters; at most 200 are allowed";
    const auto is_control = [](char ch) { return static_cast<unsigned char>(ch) < 0x20 || ch == 0x7f; };
    if (std::any_of(id.begin(), id.end(), is_control)) return "has an id with a control character";
    if (id == "*") return "has the id '*', which is reserved for all objects";
    return {};
}

/// A group that consists of one compref only shares the component that it refers to.
bool is_alias(const ComponentNode& node)
{
    return node.type.empty() && node.references.size() == 1 && node.children.empty() && node.values.empty();
}

void declare(Compilation& c, const ComponentNode& node, std::size_t parent, const Cell* cell)
{
    if (c.limit_reported || too_many(c, 1, node.where, node.id.empty() ? "component" : node.id)) return;
    Draft d;
    d.id = component_id(cell, node.id);
    d.name = node.name;
    d.type_name = node.type;
    d.node = &node;
    d.cell = cell;
    d.parent = parent;
    d.where = node.where;
    const std::size_t i = add_draft(c, std::move(d));
    bind_type(c, i);
    for (const ComponentNode& child : node.children) declare(c, child, i, cell);
}

void collect_names(const std::vector<CommandNode>& commands, Names& out)
{
    for (const CommandNode& command : commands)
    {
        if (!command.id.empty()) out.insert(command.id);
        collect_names(command.children, out);
    }
}

std::size_t collect_names(const std::vector<ComponentNode>& nodes, Names& components, Names& commands)
{
    std::size_t count = nodes.size();
    for (const ComponentNode& node : nodes)
    {
        if (!node.id.empty()) components.insert(node.id);
        collect_names(node.commands, commands);
        count += collect_names(node.children, components, commands);
    }
    return count;
}

void declare_repeat(Compilation& c, const RepeatNode& node)
{
    const Result<Repeat> repeat = read_repeat(node);
    if (!repeat)
    {
        for (const Error& e : repeat.errors()) c.report.add(e.where, "repeat", e.reason);
        return;
    }
    Names& components = c.repeated_names.emplace_back();
    Names& commands = c.repeated_names.emplace_back();
    const std::size_t per_cell = std::max<std::size_t>(1, collect_names(node.components, components, commands));
    // Three counts are at most 1e6 each: the product of more than one cell's components would not fit 64 bits.
    const bool overflows = repeat->cells() > std::numeric_limits<std::size_t>::max() / 16 / per_cell;
    const std::size_t wanted = overflows ? std::numeric_limits<std::size_t>::max() / 16 : repeat->cells() * per_cell;
    if (c.limit_reported || too_many(c, wanted, node.where, "repeat")) return;
    std::size_t group = kNone;
    if (!repeat->id.empty())
    {
        Draft d;
        d.id = repeat->id;
        d.where = node.where;
        group = add_draft(c, std::move(d));
    }
    for (std::size_t n = 0; n < repeat->cells(); ++n)
    {
        Cell& cell = c.cells.emplace_back();
        cell.components = &components;
        cell.commands = &commands;
        cell.suffix = repeat->suffix(n);
        const std::string first = node.components.empty() ? std::string() : node.components.front().id + cell.suffix;
        cell.offset = repeat->offset(n, c.settings.seed, first);
        for (const ComponentNode& component : node.components) declare(c, component, group, &cell);
    }
}

bool is_above(const SourceLocation& a, const SourceLocation& b) { return a.line != b.line ? a.line < b.line : a.column < b.column; }

/// The draft that a compref of `i` names, or kNone after an error was reported.
std::size_t find_reference(Compilation& c, std::size_t i, std::size_t n)
{
    const Draft& d = c.draft(i);
    const SourceLocation& where = n < d.node->reference_places.size() ? d.node->reference_places[n] : d.where;
    const std::string id = component_id(d.cell, d.node->references[n]);
    const std::size_t found = c.directory.find(id);
    if (found == kNone) c.report.add_unknown_id(where, c.element(i), "compref: no component has the id " + quoted(id), id);
    return found;
}

/// Everything inside a group counts as an edge of a possible circular reference: its comprefs and its children.
void refuse_circles(Compilation& c)
{
    std::vector<std::vector<std::size_t>> edges(c.directory.drafts.size());
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
        const Draft& d = c.draft(i);
        if (d.existing) continue;
        if (d.alias != kNone) edges[i].push_back(d.alias);
        edges[i].insert(edges[i].end(), d.group.begin(), d.group.end());
        edges[i].insert(edges[i].end(), d.children.begin(), d.children.end());
    }
    for (const std::vector<std::size_t>& circle : find_circles(edges))
    {
        std::vector<std::string> path;
        for (const std::size_t i : circle)
        {
            path.push_back(c.draft(i).id);
            c.draft(i).broken = true;
        }
        path.push_back(c.draft(circle.front()).id);
        std::string text;
        for (std::size_t k = 0; k < path.size(); ++k)
            if (k < 8 || k + 1 == path.size()) text += (k > 0 ? (k == 8 ? " -> ... -> " : " -> ") : "") + quoted(path[k]);
        c.complain(circle.front(), c.draft(circle.front()).where, "circular reference: " + text);
    }
}

/// Points each alias to its final target, so that long chains are followed only once.
void flatten_aliases(Compilation& c)
{
    std::vector<std::size_t> path;
    std::vector<bool> seen(c.directory.drafts.size(), false);
    for (std::size_t i = 0; i < seen.size(); ++i)
    {
        path.clear();
        std::size_t end = i;
        for (; c.draft(end).alias != kNone && !seen[end]; end = c.draft(end).alias)
        {
            seen[end] = true;
            path.push_back(end);
        }
        // A path that meets itself has no target; refuse_circles() reports that.
        const bool circle = std::find(path.begin(), path.end(), end) != path.end();
        const std::size_t target = c.draft(end).alias == kNone ? end : c.draft(end).alias;
        for (const std::size_t k : path)
        {
            c.draft(k).alias = circle ? kNone : target;
            c.draft(k).broken = c.draft(k).broken || circle;
        }
    }
}

}  // namespace

bool too_many(Compilation& c, std::size_t more, const SourceLocation& where, const std::string& element)
{
    const std::size_t before = c.directory.drafts.size(), most = c.limits.components;
    if (more <= most - std::min(most, before)) return false;
    std::string why = more == 1 ? "is one component too many" : "makes " + std::to_string(more) + " components";
    if (before > 0 && more > 1) why += " in addition to the " + std::to_string(before) + " before it";
    why += ": a scene has at most " + std::to_string(most);
    if (!c.limits.raised_by.empty()) why += " (" + c.limits.raised_by + " raises that)";
    if (!std::exchange(c.limit_reported, true)) c.report.add(where, element, why);
    return true;
}

std::string Compilation::element(std::size_t i) const
{
    const Draft& d = directory.drafts[i];
    const std::string shown = quoted(d.id);
    const std::string id = trimmed(d.id).empty() ? "component" : shown.substr(1, shown.size() - 2);
    return d.type_name.empty() ? id : id + " (" + d.type_name + ")";
}

bool Compilation::is_type_name(const std::string& name)
{
    if (type_names.empty()) type_names = types->names();
    return std::binary_search(type_names.begin(), type_names.end(), name);
}

Result<std::string> Compilation::full_type_name(const std::string& written, const std::string& within)
{
    if (is_type_name(written)) return written;
    return model::full_type_name(written, type_names, within);
}

const Result<const ComponentType*>& Compilation::require(const std::string& type)
{
    const auto it = loaded.find(type);
    return it != loaded.end() ? it->second : loaded.emplace(type, types->require(type)).first->second;
}

std::size_t add_draft(Compilation& c, Draft draft)
{
    const std::size_t i = c.directory.drafts.size();
    if (draft.parent != kNone) c.draft(draft.parent).children.push_back(i);
    Draft& d = c.directory.drafts.emplace_back(std::move(draft));
    if (const std::string why = why_no_id(d.id); !why.empty())
    {
        d.broken = true;
        c.complain(i, d.where, why);
        return i;
    }
    const auto [it, fresh] = c.directory.index.emplace(d.id, i);
    if (fresh) return i;
    const Draft& first = c.draft(it->second);
    // The id as written, not the one of the cell, so that a repetition is reported once.
    const std::string id = quoted(d.node ? d.node->id : d.id);
    d.broken = true;
    c.complain(i, d.where,
               first.existing ? "id " + id + " is already in the scene" : "id " + id + " is already used at " + place_text(first.where));
    return i;
}

void bind_type(Compilation& c, std::size_t i)
{
    Draft& d = c.draft(i);
    if (d.type_name.empty()) return;
    Result<std::string> name = c.full_type_name(d.type_name);
    if (!name)
    {
        d.broken = true;
        return c.complain(i, d.where, name.error().reason);
    }
    d.type_name = name.take();
    const Result<const ComponentType*>& type = c.require(d.type_name);
    if (!type)
    {
        d.broken = true;
        for (const Error& e : type.errors()) c.complain(i, d.where, e.reason);
        return;
    }
    d.type = *type;
    d.roles.resize(d.type->schema.roles().size());
}

void declare_existing(Compilation& c)
{
    if (!c.existing) return;
    Directory& directory = c.directory;
    for (const ComponentSpec& spec : c.existing->components)
    {
        Draft& d = directory.drafts.emplace_back();
        d.id = spec.id;
        d.type_name = spec.type;
        d.existing = &spec;
        d.where = spec.where;
        directory.index.emplace(d.id, directory.drafts.size() - 1);
        bind_type(c, directory.drafts.size() - 1);
    }
    for (std::size_t i = 0; i < directory.drafts.size(); ++i)
    {
        Draft& d = directory.drafts[i];
        d.parent = directory.find(d.existing->parent);
        if (d.parent != kNone) directory.drafts[d.parent].children.push_back(i);
        d.alias = directory.find(d.existing->alias_of);
        for (const std::string& id : d.existing->group)
            if (const std::size_t member = directory.find(id); member != kNone) d.group.push_back(member);
    }
}

void declare_components(Compilation& c)
{
    // Each of the two lists of the tree is in document order; merge them by their places.
    const std::vector<RepeatNode>& repeats = c.blueprint->repeats;
    std::size_t next = 0;
    for (const ComponentNode& node : c.blueprint->components)
    {
        while (next < repeats.size() && is_above(repeats[next].where, node.where)) declare_repeat(c, repeats[next++]);
        declare(c, node, kNone, nullptr);
    }
    while (next < repeats.size()) declare_repeat(c, repeats[next++]);
}

void link_references(Compilation& c)
{
    for (std::size_t i = 0; i < c.directory.drafts.size(); ++i)
    {
        Draft& d = c.draft(i);
        if (!d.node) continue;
        for (std::size_t n = 0; n < d.node->references.size(); ++n)
        {
            const std::size_t found = find_reference(c, i, n);
            if (found == kNone)
                d.broken = true;
            else if (is_alias(*d.node))
                d.alias = found;
            else
                d.group.push_back(found);
        }
    }
    refuse_circles(c);
    flatten_aliases(c);
}

}  // namespace plab::model::detail
