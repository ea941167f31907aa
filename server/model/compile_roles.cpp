/// Resolves participants: from written ids to components, and the restrictions on participants.

#include <algorithm>

#include "model/compile_internal.h"
#include "model/names.h"
#include "model/text.h"

namespace plab::model::detail
{

namespace
{

/// Limit for all lists of participants together: "*" in every component of a large scene would exhaust the memory.
constexpr std::size_t kMostParticipants = 4'000'000;

void refuse(Compilation& c, std::size_t i, GivenRole& given, const SourceLocation& where, std::string why)
{
    given.unresolved = true;
    c.complain(i, where, std::move(why));
}

/// Why a role for one participant takes no `*` and no pattern.
std::string why_not_one(const Role& role, const GivenRole& given)
{
    const std::string written = given.patterns.empty() ? "'*' means all objects" : quoted(given.patterns.front()) + " is a pattern of ids";
    return "role " + role.name + " takes one participant, but " + written;
}

/// A pattern that no component matches is a typing error: what it should have stood for would be missed much later.
void check_patterns(Compilation& c, std::size_t i, const Role& role, GivenRole& given)
{
    const auto& drafts = c.directory.drafts;
    for (const std::string& pattern : given.patterns)
    {
        // One with an error of its own would fit without it.
        const auto fits = [&](const Draft& d) { return matches(pattern, d.id) && (d.broken || (d.type && accepts(role, *d.type))); };
        if (std::none_of(drafts.begin(), drafts.end(), fits))
            refuse(c, i, given, given.where,
                   "role " + role.name + " needs " + describe_wanted(role) + ", and " + quoted(pattern) + " matches none");
    }
}

/// All components that fit, except the component itself: those of `patterns`, or all of "*". Those that were named take part already.
void add_everyone(Compilation& c, std::size_t i, const Role& role, GivenRole& given)
{
    if (role.one) return refuse(c, i, given, given.where, why_not_one(role, given));
    const std::vector<std::size_t> named = given.members;
    for (std::size_t k = 0; k < c.directory.drafts.size(); ++k)
    {
        const Draft& d = c.draft(k);
        if (k == i || !d.type || d.broken || !accepts(role, *d.type) || !takes_part(given.patterns, d.id)) continue;
        if (std::find(named.begin(), named.end(), k) == named.end()) given.members.push_back(k);
    }
    check_patterns(c, i, role, given);
    for (const std::size_t k : named) given.patterns.push_back(c.draft(k).id);
}

void add_participants(Compilation& c, std::size_t i, const Role& role, GivenRole& given, const Reference& reference)
{
    const Participants found = find_participants(c.directory, reference.id, role);
    given.unresolved = given.unresolved || found.broken;
    if (found.unknown)
    {
        given.unresolved = true;
        return c.report.add_unknown_id(reference.where, c.element(i), found.why, reference.id);
    }
    if (!found.why.empty()) return refuse(c, i, given, reference.where, found.why);
    const bool itself = found.members.size() == 1 && found.members.front() == i;
    if (itself) return refuse(c, i, given, reference.where, "role " + role.name + ": a component cannot be its own participant");
    for (const std::size_t k : found.members)
        if (k != i) given.members.push_back(k);
}

void check_count(Compilation& c, std::size_t i, const Role& role, GivenRole& given)
{
    const std::size_t has = given.members.size();
    const std::string wanted = describe_wanted(role);
    if (has > role.max) return refuse(c, i, given, given.where, "role " + role.name + " takes one participant, has " + std::to_string(has));
    // Objects that "*" denotes may be added later.
    if (given.everyone || has >= role.min) return;
    const char* const further = role.many ? ", several, or '*' for all that fit" : "";
    if (!given.given) return refuse(c, i, given, c.draft(i).where, role.name + " is missing: name " + wanted + further);
    refuse(c, i, given, given.where,
           "role " + role.name + " needs at least " + std::to_string(role.min) + " participants, has " + std::to_string(has));
}

void resolve_role(Compilation& c, std::size_t i, const Role& role, GivenRole& given)
{
    for (const Reference& reference : given.references) add_participants(c, i, role, given, reference);
    if (given.everyone && !given.unresolved) add_everyone(c, i, role, given);
    std::sort(given.members.begin(), given.members.end(), [&](std::size_t a, std::size_t b) { return c.draft(a).id < c.draft(b).id; });
    const auto twice = std::adjacent_find(given.members.begin(), given.members.end());
    if (twice != given.members.end())
        return refuse(c, i, given, given.where, "role " + role.name + " names " + quoted(c.draft(*twice).id) + " twice");
    if (!given.unresolved) check_count(c, i, role, given);
}

/// Members of an existing component's role, for rules that reach across scenes.
std::vector<std::size_t> existing_members(const Compilation& c, const Draft& d, const std::string& role)
{
    std::vector<std::size_t> out;
    for (const RoleSpec& spec : d.existing->roles)
    {
        if (spec.name != role) continue;
        for (const std::string& id : spec.members)
            if (const std::size_t k = c.directory.find(id); k != kNone) out.push_back(k);
    }
    return out;
}

void check_exclusive(Compilation& c)
{
    std::unordered_map<std::string, std::size_t> taken;  // by role and participant: the component that acts on it
    for (std::size_t i = 0; i < c.directory.drafts.size(); ++i)
    {
        Draft& d = c.draft(i);
        for (std::size_t k = 0; d.type && k < d.roles.size(); ++k)
        {
            const Role& role = d.type->schema.roles()[k];
            if (!role.exclusive) continue;
            for (const std::size_t member : d.existing ? existing_members(c, d, role.name) : d.roles[k].members)
            {
                const auto [it, fresh] = taken.emplace(role.name + ":" + std::to_string(member), i);
                if (!fresh && it->second != i)
                    c.complain(i, d.roles[k].where.line > 0 ? d.roles[k].where : d.where,
                               quoted(c.draft(member).id) + " is " + role.name + " of " + c.element(it->second) +
                                   " already: only one component can have it in this role");
            }
        }
    }
}

/// A joint from a body to itself holds nothing: of two roles that act on one participant each, the second was meant to be another one.
void check_different(Compilation& c, std::size_t i)
{
    const Draft& d = c.draft(i);
    std::unordered_map<std::size_t, std::size_t> taken;  // by participant: the role
    for (std::size_t k = 0; k < d.roles.size(); ++k)
    {
        const Role& role = d.type->schema.roles()[k];
        if (!role.one || !role.writes || d.roles[k].unresolved || d.roles[k].members.size() != 1) continue;
        const auto [other, fresh] = taken.emplace(d.roles[k].members.front(), k);
        if (!fresh)
            c.complain(i, d.roles[k].where,
                       "roles " + d.type->schema.roles()[other->second].name + " and " + role.name + " are both " +
                           quoted(c.draft(other->first).id) + ": they must be two");
    }
}

/// Finds components that participate in each other; also shapes that position each other.
void check_circles(Compilation& c)
{
    std::vector<std::vector<std::size_t>> edges(c.directory.drafts.size());
    for (std::size_t i = 0; i < edges.size(); ++i)
    {
        const Draft& d = c.draft(i);
        for (std::size_t k = 0; d.type && k < d.roles.size(); ++k)
            edges[i].insert(edges[i].end(), d.roles[k].members.begin(), d.roles[k].members.end());
    }
    for (const std::vector<std::size_t>& circle : find_circles(edges))
    {
        std::string text;
        for (std::size_t k = 0; k < circle.size() && k < 8; ++k) text += quoted(c.draft(circle[k]).id) + " -> ";
        text += (circle.size() > 8 ? "... -> " : "") + quoted(c.draft(circle.front()).id);
        c.complain(circle.front(), c.draft(circle.front()).where, "circular reference: " + text);
    }
}

}  // namespace

void resolve_roles(Compilation& c)
{
    std::size_t participants = 0;
    for (std::size_t i = 0; i < c.directory.drafts.size(); ++i)
    {
        Draft& d = c.draft(i);
        if (!d.type || d.existing) continue;
        for (std::size_t k = 0; k < d.roles.size(); ++k)
        {
            resolve_role(c, i, d.type->schema.roles()[k], d.roles[k]);
            participants += d.roles[k].members.size();
            if (participants > kMostParticipants)
                return c.report.add(c.blueprint->where, {}, "the roles of the scene have more than 4000000 participants together");
        }
    }
}

void check_roles(Compilation& c)
{
    check_exclusive(c);
    for (std::size_t i = 0; i < c.directory.drafts.size(); ++i)
        if (c.draft(i).type && !c.draft(i).existing) check_different(c, i);
    check_circles(c);
}

}  // namespace plab::model::detail
