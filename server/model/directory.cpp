/// Finds the components that an id denotes.

#include <algorithm>

#include "model/compile_internal.h"
#include "model/text.h"

namespace plab::model::detail
{

std::size_t Directory::find(const std::string& id) const
{
    const auto it = index.find(id);
    return it == index.end() ? kNone : it->second;
}

std::size_t Directory::follow(std::size_t i) const
{
    // A chain without a cycle is at most as long as the number of drafts.
    for (std::size_t steps = 0; steps <= drafts.size(); ++steps)
    {
        if (i == kNone || drafts[i].alias == kNone) return i;
        i = drafts[i].alias;
    }
    return kNone;
}

std::vector<std::size_t> Directory::inside(std::size_t group) const
{
    std::vector<std::size_t> found;
    std::unordered_set<std::size_t> seen{group};
    std::vector<std::size_t> open{group};
    while (!open.empty())
    {
        const Draft& at = drafts[open.back()];
        open.pop_back();
        const auto enter = [&](std::size_t i)
        {
            i = follow(i);
            if (i == kNone || !seen.insert(i).second) return;
            if (!drafts[i].type_name.empty()) found.push_back(i);
            open.push_back(i);
        };
        for (const std::size_t child : at.children) enter(child);
        for (const std::size_t member : at.group) enter(member);
    }
    return found;
}

bool accepts(const Role& role, const ComponentType& type)
{
    return std::any_of(role.facets.begin(), role.facets.end(),
                       [&](Facet facet)
                       { return facet == Facet::Component ? type.info.name.starts_with(role.family) : facet == type.info.facet; });
}

std::string describe_wanted(const Role& role)
{
    std::string out;
    for (const Facet facet : role.facets)
    {
        constexpr std::string_view words[] = {"a component", "a body", "a shaft", "a shape", "quantities"};
        out += (out.empty() ? "" : " or ") + std::string(words[static_cast<int>(facet)]);
        if (facet == Facet::Component && !role.family.empty())
            out += " of type " + role.family + (role.family.ends_with('/') ? "..." : "/...");
    }
    return out;
}

namespace
{

std::string describe(const Draft& draft)
{
    constexpr std::string_view words[] = {"", ", a body", ", a shaft", ", a shape", ", quantities"};
    if (!draft.type) return quoted(draft.id);
    return quoted(draft.id) + " is " + draft.type->info.name + std::string(words[static_cast<int>(draft.type->info.facet)]);
}

/// The participants that an object or a group provides for a role.
Participants find_inside(const Directory& directory, std::size_t group, const Role& role)
{
    Participants out;
    for (const std::size_t i : directory.inside(group))
    {
        const Draft& d = directory.drafts[i];
        out.broken = out.broken || d.broken;
        if (d.type && accepts(role, *d.type)) out.members.push_back(i);
    }
    const std::string id = quoted(directory.drafts[group].id);
    if (out.members.empty() && !out.broken)
        out.why = "role " + role.name + " needs " + describe_wanted(role) + ", and " + id + " holds none";
    if (!role.one || out.members.size() < 2) return out;
    std::vector<std::string> ids;
    for (const std::size_t i : out.members) ids.push_back(directory.drafts[i].id);
    std::sort(ids.begin(), ids.end());
    out.why = "role " + role.name + " takes one participant, and " + id + " holds " + std::to_string(ids.size()) + " that fit (" +
              quoted_list(ids) + "): name one of them";
    out.members.clear();
    return out;
}

}  // namespace

Participants find_participants(const Directory& directory, const std::string& written, const Role& role)
{
    Participants out;
    const std::size_t found = directory.find(written);
    if (found == kNone)
    {
        out.unknown = true;
        out.why = "role " + role.name + ": no component has the id " + quoted(written);
        return out;
    }
    const std::size_t i = directory.follow(found);
    if (i == kNone || directory.drafts[i].broken)
    {
        out.broken = true;
        return out;
    }
    const Draft& d = directory.drafts[i];
    if (d.type_name.empty()) return find_inside(directory, i, role);
    if (d.type && accepts(role, *d.type))
        out.members.push_back(i);
    else
        out.why = "role " + role.name + " needs " + describe_wanted(role) + ", but " + describe(d);
    return out;
}

std::vector<std::vector<std::size_t>> find_circles(const std::vector<std::vector<std::size_t>>& edges)
{
    constexpr std::size_t kMostCircles = 100;
    enum class Mark : unsigned char
    {
        New,
        OnPath,
        Done
    };
    std::vector<Mark> marks(edges.size(), Mark::New);
    std::vector<std::size_t> next(edges.size(), 0);
    std::vector<std::vector<std::size_t>> circles;
    std::vector<std::size_t> path;  // depth first, without recursion: chains can be as long as the scene
    for (std::size_t start = 0; start < edges.size(); ++start)
    {
        if (marks[start] != Mark::New) continue;
        path.push_back(start);
        marks[start] = Mark::OnPath;
        while (!path.empty())
        {
            const std::size_t at = path.back();
            if (next[at] == edges[at].size())
            {
                marks[at] = Mark::Done;
                path.pop_back();
                continue;
            }
            const std::size_t to = edges[at][next[at]++];
            if (marks[to] == Mark::OnPath && circles.size() < kMostCircles)
                circles.emplace_back(std::find(path.begin(), path.end(), to), path.end());
            if (marks[to] != Mark::New) continue;
            marks[to] = Mark::OnPath;
            path.push_back(to);
        }
    }
    return circles;
}

}  // namespace plab::model::detail
