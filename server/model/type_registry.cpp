#include "model/type_registry.h"

#include <algorithm>
#include <set>
#include <string>

#include "model/text.h"
#include "model/values.h"

namespace plab::model
{

namespace
{

bool names_objects(const Role& role)
{
    const auto is_object = [](Facet f) { return f == Facet::Body || f == Facet::Shaft || f == Facet::Quantities; };
    return std::any_of(role.facets.begin(), role.facets.end(), is_object);
}

bool is_snake_case(std::string_view name)
{
    if (name.empty() || !is_lower(name.front()) || name.back() == '_') return false;
    return std::all_of(name.begin(), name.end(), [](char c) { return is_lower(c) || is_digit(c) || c == '_'; });
}

/// Kind/Algorithm or Kind/Family/Algorithm; each part begins with a capital.
bool is_type_name(std::string_view name)
{
    int parts = 0;
    bool begins = true;
    for (const char c : name)
    {
        if (begins)
        {
            if (!is_upper(c)) return false;
            ++parts;
        }
        else if (c != '/' && !is_letter(c) && !is_digit(c))
            return false;
        begins = c == '/';
    }
    return !begins && (parts == 2 || parts == 3);
}

/// Names that begin with `within` and whose last parts are `written`.
std::vector<std::string> names_ending_in(std::string_view written, const std::vector<std::string>& names, std::string_view within)
{
    const std::string ending = "/" + std::string(written);
    std::vector<std::string> out;
    for (const std::string& name : names)
        if (name.starts_with(within) && name.ends_with(ending)) out.push_back(name);
    return out;
}

/// Collects the errors of one type.
class TypeCheck
{
public:
    TypeCheck(const ComponentType& type, Errors& errors) : type_(&type), errors_(&errors) {}

    void run()
    {
        if (!is_type_name(type_->info.name)) complain("type names must have the form Kind/Algorithm or Kind/Family/Algorithm");
        if (type_->info.family.empty()) complain("its family is empty");
        for (const Field& field : type_->schema.fields()) check_field(field);
        for (const Role& role : type_->schema.roles()) check_role(role);
        std::set<std::string> commands;
        for (const CommandInfo& c : type_->info.commands)
        {
            if (c.name.empty()) complain("a command has no name");
            if (!commands.insert(c.name).second) complain("command " + quoted(c.name) + " is declared twice");
        }
    }

private:
    void complain(const std::string& why) { errors_->push_back({{}, type_->info.name, why}); }

    void check_name(const std::string& name)
    {
        if (!is_snake_case(name)) complain(quoted(name) + " must be in snake_case");
        if (name == "id" || name == "name" || name == "type") complain(quoted(name) + " is already an attribute of every component");
        if (!names_.insert(name).second) complain(quoted(name) + " is declared twice");
    }

    void check_field(const Field& field)
    {
        check_name(field.name);
        const bool settable = field.kind == FieldKind::Param || field.kind == FieldKind::State;
        if (settable && field.type == FieldType::Opaque) complain(field.name + " cannot be set: its type has no text form");
        for (const Rule& rule : field.rules)
            if (rule.kind == Rule::Kind::OneOf && (rule.options.empty() || field.type != FieldType::Text))
                complain(field.name + " has options, but its type cannot have any");
        if (!settable || field.required || field.fallback.index() == 0) return;
        Value value = field.fallback;
        if (Result<void> r = check_value(value, field); !r) return complain("the default breaks its own rule: " + r.error().reason);
        if (value != field.fallback) complain("the default of " + field.name + " must be of unit length");
    }

    void check_role(const Role& role)
    {
        check_name(role.name);
        const bool takes_components = std::find(role.facets.begin(), role.facets.end(), Facet::Component) != role.facets.end();
        if (role.facets.empty()) complain("role " + role.name + " accepts no component: it names no facet");
        if (role.min > role.max) complain("role " + role.name + " needs more participants than it takes");
        if (!role.default_type.empty() && !takes_components) complain("role " + role.name + " has a default type but takes no components");
        if (!role.default_type.empty() && !role.default_type.starts_with(role.family))
            complain("role " + role.name + " has a default type outside its family " + role.family);
        if (role.exclusive && !role.writes) complain("role " + role.name + " is exclusive, so it must be declared as writing");
    }

    const ComponentType* type_;
    Errors* errors_;
    std::set<std::string> names_;
};

std::string role_list(const Schema& schema)
{
    std::vector<std::string> names;
    for (const Role& r : schema.roles()) names.push_back(r.name);
    return names.empty() ? "none" : quoted_list(names);
}

}  // namespace

Result<std::string> full_type_name(std::string_view written, const std::vector<std::string>& names, std::string_view within)
{
    if (written.empty() || std::find(names.begin(), names.end(), written) != names.end()) return std::string(written);
    std::vector<std::string> fitting = names_ending_in(written, names, within);
    if (fitting.empty()) fitting = names_ending_in(written, names, {});
    if (fitting.size() > 1) return reason("type " + quoted(written) + " can be " + quoted_list(fitting, "or") + ": give the whole name");
    return fitting.empty() ? std::string(written) : fitting.front();
}

int ComponentType::find_command(std::string_view name) const
{
    for (std::size_t i = 0; i < info.commands.size(); ++i)
        if (info.commands[i].name == name) return static_cast<int>(i);
    return -1;
}

bool ComponentType::takes_part(Phase phase) const
{
    return std::any_of(info.commands.begin(), info.commands.end(), [&](const CommandInfo& c) { return c.phase == phase; });
}

bool ComponentType::only_advances() const
{
    const auto advances = [](const CommandInfo& c)
    { return c.phase == Phase::Advance || c.phase == Phase::Measure || c.phase == Phase::Prepare; };
    return info.facet == Facet::Component && schema.roles().empty() && takes_part(Phase::Advance) &&
           std::all_of(info.commands.begin(), info.commands.end(), advances);
}

bool ComponentType::only_answers_contacts() const
{
    const auto answers = [](const CommandInfo& c)
    {
        return c.phase == Phase::Choose || c.phase == Phase::Locate || c.phase == Phase::Respond || c.phase == Phase::Touch ||
               c.phase == Phase::Solve;
    };
    const auto does_no_more = [&](const CommandInfo& c) { return answers(c) || c.phase == Phase::Prepare || c.phase == Phase::Potential; };
    const auto& commands = info.commands;
    return info.facet == Facet::Component && std::ranges::none_of(schema.roles(), names_objects) &&
           std::ranges::any_of(commands, answers) && std::ranges::all_of(commands, does_no_more);
}

bool ComponentType::concerns_contacts() const
{
    if (only_advances()) return false;
    const auto of_contacts = [](const CommandInfo& c)
    {
        return c.phase == Phase::Choose || c.phase == Phase::Touch || c.phase == Phase::Solve || c.phase == Phase::Detect ||
               c.phase == Phase::Gap || c.phase == Phase::Locate || c.phase == Phase::Respond;
    };
    const bool acts = std::any_of(schema.roles().begin(), schema.roles().end(), names_objects);
    return info.facet != Facet::Component || !acts || std::any_of(info.commands.begin(), info.commands.end(), of_contacts);
}

std::string ComponentType::why_not_exchangeable(const ComponentType& other) const
{
    constexpr std::string_view facets[] = {"a component", "a body", "a shaft", "a shape", "quantities"};
    if (info.family != other.info.family)
        return info.name + " is of family " + info.family + ", " + other.info.name + " of family " + other.info.family;
    if (info.facet != other.info.facet)
        return info.name + " is " + std::string(facets[static_cast<int>(info.facet)]) + ", " + other.info.name + " is " +
               std::string(facets[static_cast<int>(other.info.facet)]);
    for (const Role& a : schema.roles())
    {
        const Role* b = other.schema.find_role(a.name);
        if (!b) continue;
        if (a.facets != b->facets || a.family != b->family) return "role " + a.name + " takes different kinds of participants";
        if ((a.one == nullptr) != (b->one == nullptr)) return "role " + a.name + " takes one participant in one type and many in the other";
    }
    // An optional role that only one of the types has is dropped or left empty; a required one must have a participant, or a
    // default type from which one can be made.
    const auto lacks_required = [](const Schema& from, const Schema& in)
    {
        return std::any_of(from.roles().begin(), from.roles().end(),
                           [&](const Role& r) { return r.min > 0 && r.default_type.empty() && !in.find_role(r.name); });
    };
    if (!lacks_required(schema, other.schema) && !lacks_required(other.schema, schema)) return {};
    return info.name + " has the roles " + role_list(schema) + ", " + other.info.name + " has " + role_list(other.schema);
}

Result<void> TypeRegistry::add(Registrar&& registrar, const std::string& plugin)
{
    std::deque<ComponentType> fresh;
    Errors errors;
    for (TypeInfo& info : registrar.types())
    {
        const auto same = [&](const ComponentType& t) { return t.info.name == info.name; };
        if (const ComponentType* known = find(info.name))
            errors.push_back({{}, info.name, "is already declared by plugin " + quoted(known->plugin)});
        else if (std::any_of(fresh.begin(), fresh.end(), same))
            errors.push_back({{}, info.name, "is declared twice"});
        ComponentType& type = fresh.emplace_back();
        type.info = std::move(info);
        type.plugin = plugin;
        if (!type.info.make)
        {
            errors.push_back({{}, type.info.name, "has no table"});
            continue;
        }
        type.prototype = type.info.make();
        type.prototype->describe(type.schema);
        TypeCheck(type, errors).run();
    }
    for (Error& e : errors) e.where.file = "plugin " + plugin;
    if (!errors.empty()) return errors;
    for (ComponentType& type : fresh) types_.push_back(std::move(type));
    return {};
}

const ComponentType* TypeRegistry::find(std::string_view name) const
{
    for (const ComponentType& t : types_)
        if (t.info.name == name) return &t;
    return nullptr;
}

}  // namespace plab::model
