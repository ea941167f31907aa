/// What short forms leave out: nested components that fill roles, parts with a default type, the default solver.

#include <algorithm>

#include "model/compile_internal.h"
#include "model/text.h"
#include "model/values.h"

namespace plab::model::detail
{

namespace
{

bool is_component_role(const Role& role)
{
    return std::find(role.facets.begin(), role.facets.end(), Facet::Component) != role.facets.end();
}

/// Roles that a nested component may fill without being named: not those that any component would fit.
bool takes_unnamed(const Role& role) { return !is_component_role(role) || !role.family.empty(); }

bool is_solver_role(const Role& role) { return role.name == "solver" && role.family.starts_with("Solver"); }

bool is_part_of(const Draft& part, std::size_t whole) { return part.parent == whole; }

/// A nested component, or one shared by a compref, which may fill a role of the enclosing component.
struct Candidate
{
    std::string id;              ///< as referred to
    std::size_t target = kNone;  ///< through aliases
    SourceLocation where;
    bool must_fit = false;  ///< a compref in a typed component has no other purpose
};

std::vector<Candidate> candidates_of(Compilation& c, std::size_t i)
{
    std::vector<Candidate> out;
    const Draft& d = c.draft(i);
    const auto add = [&](std::size_t k, bool must_fit)
    {
        const std::size_t target = c.directory.follow(k);
        if (target != kNone && c.draft(target).type && !c.draft(k).generated)
            out.push_back({c.draft(k).id, target, must_fit ? d.where : c.draft(k).where, must_fit});
    };
    for (const std::size_t child : d.children) add(child, false);
    for (const std::size_t shared : d.group) add(shared, true);
    return out;
}

/// The components that the roles of `i` already name.
std::unordered_set<std::size_t> named_by(const Compilation& c, const Draft& d)
{
    std::unordered_set<std::size_t> out;
    for (const GivenRole& given : d.roles)
        for (const Reference& r : given.references) out.insert(c.directory.follow(c.directory.find(r.id)));
    return out;
}

void fill(GivenRole& given, const Candidate& candidate)
{
    given.given = true;
    given.where = candidate.where;
    given.references.push_back({candidate.id, candidate.where});
}

/// The open roles of `i` that the candidate fits.
std::vector<std::size_t> fitting_roles(Compilation& c, std::size_t i, const Candidate& candidate, const std::vector<bool>& open)
{
    const Draft& d = c.draft(i);
    std::vector<std::size_t> fitting;
    for (std::size_t k = 0; k < d.roles.size(); ++k)
    {
        const Role& role = d.type->schema.roles()[k];
        if (open[k] && takes_unnamed(role) && accepts(role, *c.draft(candidate.target).type)) fitting.push_back(k);
    }
    return fitting;
}

/// Whether the candidate's id marks it as the part for this role: "red.shape" in "red".
bool is_called_after(const Draft& d, const Candidate& candidate, const Role& role)
{
    return candidate.id == d.id + "." + role.name || (d.node && candidate.id == component_id(d.cell, d.node->id + "." + role.name));
}

/// Assigns nested components to the roles that their ids name; returns the remaining ones.
std::vector<Candidate> wire_by_id(Compilation& c, std::size_t i, std::vector<bool>& open)
{
    Draft& d = c.draft(i);
    std::vector<Candidate> rest;
    const std::unordered_set<std::size_t> named_before = named_by(c, d);
    for (const Candidate& candidate : candidates_of(c, i))
    {
        if (named_before.contains(candidate.target)) continue;
        const std::vector<std::size_t> roles = fitting_roles(c, i, candidate, open);
        const auto named = std::find_if(roles.begin(), roles.end(),
                                        [&](std::size_t k) { return is_called_after(d, candidate, d.type->schema.roles()[k]); });
        if (named == roles.end())
            rest.push_back(candidate);
        else
        {
            fill(d.roles[*named], candidate);
            open[*named] = d.type->schema.roles()[*named].many != nullptr;
        }
    }
    return rest;
}

/// Nested components that no role names fill the only role that they fit.
void wire_children(Compilation& c, std::size_t i)
{
    Draft& d = c.draft(i);
    std::vector<bool> open;
    for (const GivenRole& given : d.roles) open.push_back(!given.given);
    for (const Candidate& candidate : wire_by_id(c, i, open))
    {
        const std::vector<std::size_t> roles = fitting_roles(c, i, candidate, open);
        if (roles.size() > 1)
        {
            std::vector<std::string> names;
            for (const std::size_t k : roles) names.push_back(d.type->schema.roles()[k].name);
            c.complain(i, candidate.where, quoted(candidate.id) + " fits the roles " + quoted_list(names) + ": name it in one of them");
            for (const std::size_t k : roles) d.roles[k].given = d.roles[k].unresolved = true;
        }
        if (roles.empty() && candidate.must_fit)
            c.complain(i, candidate.where, "compref " + quoted(candidate.id) + " fits no open role of this component");
        if (roles.size() != 1) continue;
        GivenRole& given = d.roles[roles.front()];
        const Role& role = d.type->schema.roles()[roles.front()];
        if (!given.given || role.many)
        {
            fill(given, candidate);
            continue;
        }
        if (!given.unresolved)
            c.complain(i, candidate.where,
                       quoted(given.references.front().id) + " and " + quoted(candidate.id) + " both fit role " + role.name +
                           ": name one of them");
        given.unresolved = true;
    }
}

/// In an object without type, the only shape belongs to the only state, if the state names no shape.
void wire_object(Compilation& c, std::size_t group)
{
    std::vector<std::size_t> states;
    std::vector<Candidate> shapes;
    for (const Candidate& candidate : candidates_of(c, group))
    {
        const Facet facet = c.draft(candidate.target).type->info.facet;
        if (facet == Facet::Shape) shapes.push_back(candidate);
        const bool own = is_part_of(c.draft(candidate.target), group);
        if (own && (facet == Facet::Body || facet == Facet::Shaft)) states.push_back(candidate.target);
    }
    if (states.size() != 1 || shapes.size() != 1) return;
    Draft& state = c.draft(states.front());
    GivenRole* open = nullptr;
    for (std::size_t k = 0; k < state.roles.size(); ++k)
    {
        const std::vector<Facet>& facets = state.type->schema.roles()[k].facets;
        if (std::find(facets.begin(), facets.end(), Facet::Shape) == facets.end()) continue;
        if (state.roles[k].given || open) return;
        open = &state.roles[k];
    }
    // A shape of its own, nested in the state, comes before the object's.
    for (const std::size_t child : state.children)
        if (c.draft(child).type && c.draft(child).type->info.facet == Facet::Shape) return;
    if (open) fill(*open, shapes.front());
}

/// Makes the part "<id>.<role>" of this type, or takes the one with that id which the author wrote.
void make_part(Compilation& c, std::size_t i, std::size_t k, const std::string& type, const SourceLocation& where)
{
    const std::string role = c.draft(i).type->schema.roles()[k].name;
    GivenRole& given = c.draft(i).roles[k];
    Draft part;
    part.id = c.draft(i).id + "." + role;
    part.type_name = type;
    part.generated = true;
    part.parent = i;
    part.cell = c.draft(i).cell;
    part.where = where;
    given.given = true;
    given.may_be_type = false;
    given.where = where;
    given.references.assign(1, {part.id, where});
    if (c.limit_reported || too_many(c, 1, where, part.id)) return;
    bind_type(c, add_draft(c, std::move(part)));
}

/// An explicit component with the id that the part would have; kNone if there is none.
std::size_t find_written_part(Compilation& c, std::size_t i, const Role& role)
{
    const Draft& d = c.draft(i);
    const std::size_t found = c.directory.find(d.id + "." + role.name);
    if (found != kNone || !d.node) return found;
    return c.directory.find(component_id(d.cell, d.node->id + "." + role.name));
}

/// A single word with a slash that is not an id is the type of a part to generate.
void make_named_part(Compilation& c, std::size_t i, std::size_t k)
{
    GivenRole& given = c.draft(i).roles[k];
    const Role& role = c.draft(i).type->schema.roles()[k];
    std::string written = given.references.front().id;
    if (c.directory.find(written) != kNone) return;
    if (Result<std::string> name = c.full_type_name(written, role.family); !name)
    {
        given.unresolved = true;
        return c.complain(i, given.where, role.name + ": " + name.error().reason);
    }
    else if (*name != written)
    {
        // A word that abbreviates a type which does not fit here is treated as an unknown id.
        const Result<const ComponentType*>& type = c.require(*name);
        if (!type || !accepts(role, **type)) return;
        written = name.take();
    }
    if (written.find('/') == std::string::npos) return;
    const std::size_t own = find_written_part(c, i, role);
    if (own == kNone) return make_part(c, i, k, written, given.where);
    if (c.draft(own).type_name != written)
        c.complain(i, given.where,
                   role.name + " is " + quoted(written) + " here, but component " + quoted(c.draft(own).id) + " is of type " +
                       quoted(c.draft(own).type_name));
    given.references.front().id = c.draft(own).id;
}

void use_default_solver(Compilation& c, std::size_t i, GivenRole& given)
{
    const SourceLocation where = c.draft(i).where;
    given.given = true;
    given.where = where;
    given.unresolved = c.solver_broken;
    if (c.solver_broken) return;
    given.references.push_back({c.settings.solver, where});
    if (c.directory.find(c.settings.solver) != kNone) return;
    Draft solver;
    solver.id = c.settings.solver;
    solver.type_name = c.settings.solver_type;
    solver.generated = true;
    solver.where = c.solver_place;
    bind_type(c, add_draft(c, std::move(solver)));
}

void complete_role(Compilation& c, std::size_t i, std::size_t k)
{
    Draft& d = c.draft(i);
    const Role& role = d.type->schema.roles()[k];
    GivenRole& given = d.roles[k];
    if (given.given && given.may_be_type) return make_named_part(c, i, k);
    if (given.given) return;
    const std::size_t written = takes_unnamed(role) ? find_written_part(c, i, role) : kNone;
    if (written != kNone) return fill(given, {c.draft(written).id, written, d.where, false});
    if (is_solver_role(role)) return use_default_solver(c, i, given);
    const bool wanted = role.min > 0 || std::any_of(d.parts.begin(), d.parts.end(), [&](const GivenPart& p) { return p.role == k; });
    if (wanted && !role.default_type.empty() && is_component_role(role)) make_part(c, i, k, role.default_type, d.where);
}

/// Passes dotted attributes to the parts that they address.
void hand_down(Compilation& c, std::size_t i, const GivenPart& part)
{
    Draft& d = c.draft(i);
    const Role& role = d.type->schema.roles()[part.role];
    const GivenRole& given = d.roles[part.role];
    const std::string name = quoted(role.name + "." + part.name);
    if (given.unresolved) return;
    if (given.references.size() != 1)
        return c.complain(i, part.text->where, name + " needs a part to set: give " + role.name + " the type of one");
    const std::size_t target = c.directory.follow(c.directory.find(given.references.front().id));
    if (target == kNone || c.draft(target).broken || !c.draft(target).type) return;  // the error was reported elsewhere
    if (!is_part_of(c.draft(target), i) && target != find_written_part(c, i, role))
        return c.complain(i, part.text->where, name + ": " + quoted(c.draft(target).id) + " is not a part of this component: set it there");
    if (c.draft(target).existing)
        return c.complain(i, part.text->where, name + ": " + quoted(c.draft(target).id) + " is already in the running scene");
    give(c, target, part.name, *part.text, d.cell);
}

}  // namespace

void form_parts(Compilation& c)
{
    for (std::size_t i = 0; i < c.directory.drafts.size(); ++i)
        if (const Draft& d = c.draft(i); !d.existing && d.type_name.empty()) wire_object(c, i);
    // The list grows, because parts have roles of their own.
    for (std::size_t i = 0; i < c.directory.drafts.size(); ++i)
    {
        // A part without a place (its id is too long) ends a nesting of default types that could be endless.
        if (c.draft(i).existing || !c.draft(i).type || (c.draft(i).generated && c.draft(i).broken)) continue;
        wire_children(c, i);
        for (std::size_t k = 0; k < c.draft(i).roles.size(); ++k) complete_role(c, i, k);
        for (const GivenPart& part : c.draft(i).parts) hand_down(c, i, part);
        c.draft(i).parts_formed = true;
    }
}

}  // namespace plab::model::detail
