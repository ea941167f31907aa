#include "study/settings.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "model/names.h"
#include "model/text.h"
#include "model/values.h"

namespace plab::study
{
namespace
{

Error wrong(const Setting& s, const std::string& why) { return reason("'" + s.text() + "': " + why); }

std::vector<std::string> split(std::string_view text, char separator)
{
    std::vector<std::string> out;
    while (true)
    {
        const std::size_t at = text.find(separator);
        out.emplace_back(model::trimmed(text.substr(0, at)));
        if (at == std::string_view::npos) return out;
        text.remove_prefix(at + 1);
    }
}

/// The place of the component with this id or alias; the number of components if there is none.
std::size_t find(const model::SceneSpec& scene, const std::string& id)
{
    const std::size_t at = scene.position_of(id, 0);
    if (at == scene.components.size() || scene.components[at].alias_of.empty()) return at;
    return find(scene, scene.components[at].alias_of);
}

Error unknown_id(const model::SceneSpec& scene, const Setting& s, const std::string& id)
{
    std::vector<std::string> ids{"dt"};
    for (const model::ComponentSpec& c : scene.components) ids.push_back(c.id);
    return wrong(s, "no component has the id '" + id + "'" + model::did_you_mean(id, ids));
}

/// Roles that the old type did not have, as the short form of a blueprint fills them: the scene's solver, or a part of the
/// role's default type, which is added to the scene.
void fill_roles(model::SceneSpec& scene, model::ComponentSpec& c, const Schema& schema)
{
    std::vector<model::ComponentSpec> parts;
    for (const Role& role : schema.roles())
    {
        if (std::any_of(c.roles.begin(), c.roles.end(), [&](const model::RoleSpec& r) { return r.name == role.name; })) continue;
        if (role.family == "Solver/" && scene.find(scene.settings.solver))
        {
            c.roles.push_back({role.name, {scene.settings.solver}, false, {}});
            continue;
        }
        if (role.min == 0 || role.default_type.empty()) continue;
        model::ComponentSpec part;
        part.id = c.id + "." + role.name, part.type = role.default_type, part.generated = true;
        c.roles.push_back({role.name, {part.id}, false, {}});
        if (!scene.find(part.id)) parts.push_back(std::move(part));
    }
    for (model::ComponentSpec& part : parts) scene.components.push_back(std::move(part));
}

/// The type, or why there is none; suggestions are of the same kind.
Result<const model::ComponentType*> require_like(model::TypeSource& types, const std::string& present, const std::string& written)
{
    const std::string name = full_type_name(present, written);
    const std::vector<std::string> all = types.names();
    if (std::find(all.begin(), all.end(), name) != all.end()) return types.require(name);
    const std::string kind = present.substr(0, present.rfind('/') + 1);
    std::vector<std::string> like;
    for (const std::string& other : all)
        if (other.starts_with(kind)) like.push_back(other);
    const std::string near = model::did_you_mean(name, like);
    return reason("unknown type '" + name + "'" + (near.empty() ? "; it can be " + model::quoted_list(like, "or") : near));
}

/// Fields that both types have keep their values; the others get the new type's defaults.
Result<void> exchange(model::SceneSpec& scene, model::ComponentSpec& c, model::TypeSource& types, const Setting& s)
{
    auto old = types.require(c.type);
    auto fresh = require_like(types, c.type, s.value);
    if (!old || !fresh) return wrong(s, (old ? fresh : old).error().reason);
    if (const std::string why = (*fresh)->why_not_exchangeable(**old); !why.empty())
        return wrong(s, c.type + " cannot be exchanged for " + (*fresh)->info.name + ": " + why);
    c.type = (*fresh)->info.name;
    const Schema& schema = (*fresh)->schema;
    std::erase_if(c.fields,
                  [&](const model::FieldSpec& f)
                  {
                      const Field* field = schema.find_field(f.name);
                      return !field || field->kind == FieldKind::Output || type_of(f.value) != field->type;
                  });
    std::erase_if(c.roles, [&](const model::RoleSpec& r) { return !schema.find_role(r.name); });
    if (c.explicit_commands) std::erase_if(c.commands, [&](const std::string& name) { return (*fresh)->find_command(name) < 0; });
    fill_roles(scene, c, schema);
    return {};
}

Result<void> set_parameter(model::ComponentSpec& c, model::TypeSource& types, const std::string& name, const Setting& s)
{
    auto type = types.require(c.type);
    if (!type) return wrong(s, type.error().reason);
    const std::size_t dot = name.find('.');
    const Field* field = (*type)->schema.find_field(name.substr(0, dot));
    if (!field || field->kind == FieldKind::Output || field->kind == FieldKind::Scratch)
    {
        std::vector<std::string> names;
        for (const Field& f : (*type)->schema.fields())
            if (f.kind == FieldKind::Param || f.kind == FieldKind::State) names.push_back(f.name);
        return wrong(s, c.type + " has no parameter '" + name + "'" + model::did_you_mean(name, names));
    }
    Field numbers = *field;
    if (dot != std::string::npos) numbers.type = FieldType::Real;
    auto value = model::parse_value(s.value, numbers);
    if (!value) return wrong(s, value.error().reason);
    auto given = std::find_if(c.fields.begin(), c.fields.end(), [&](const model::FieldSpec& f) { return f.name == field->name; });
    if (dot == std::string::npos)
    {
        if (given == c.fields.end())
            c.fields.push_back({field->name, value.take(), {}});
        else
            given->value = value.take();
        return {};
    }
    auto* entries = given == c.fields.end() ? nullptr : std::get_if<Entries>(&given->value);
    if (entries)
        for (Entry& e : *entries)
            if (e.name == name.substr(dot + 1)) return e.value = std::get<double>(*value), Result<void>();
    return wrong(s, c.id + " has no entry '" + name + "'");
}

Result<void> apply_one(model::SceneSpec& scene, model::TypeSource& types, const Setting& s)
{
    if (s.is_dt())
    {
        auto dt = model::parse_step_length(s.value);
        if (!dt) return wrong(s, dt.error().reason);
        scene.settings.dt = *dt;
        return {};
    }
    const auto edit = [&](std::size_t at, auto change)
    {
        model::ComponentSpec c = scene.components[at];
        auto done = change(c);
        if (done) scene.components.replace(at, std::move(c));
        return done;
    };
    const std::size_t none = scene.components.size();
    if (const std::size_t at = find(scene, s.target); at != none)
        return scene.components[at].type.empty() ? Result<void>(wrong(s, s.target + " is a group and has no type"))
                                                 : edit(at, [&](model::ComponentSpec& c) { return exchange(scene, c, types, s); });
    for (std::size_t dot = s.target.rfind('.'); dot != std::string::npos && dot > 0; dot = s.target.rfind('.', dot - 1))
        if (const std::size_t at = find(scene, s.target.substr(0, dot)); at != none)
            return edit(at, [&](model::ComponentSpec& c) { return set_parameter(c, types, s.target.substr(dot + 1), s); });
    return unknown_id(scene, s, s.target);
}

/// "RungeKutta4" for the type of a component, "thickness 1 mm" for a parameter.
std::string words_for(const Setting& s)
{
    const bool is_type = !s.value.empty() && model::is_upper(s.value[0]);
    if (!is_type) return s.target.substr(s.target.rfind('.') + 1) + " " + s.value;
    const std::size_t slash = s.value.find('/');
    return slash == std::string::npos ? s.value : s.value.substr(slash + 1);
}

/// Of one target.
bool same_value(const Setting& a, const Setting& b)
{
    if (a.value == b.value || !a.is_dt()) return a.value == b.value;
    const auto one = model::parse_step_length(a.value), other = model::parse_step_length(b.value);
    return one && other && one->seconds == other->seconds;
}

void add_setting(Combination& c, const Setting& s)
{
    c.settings.push_back(s);
    if (s.is_dt())
        c.dt = s.value;
    else
        c.algorithm += (c.algorithm.empty() ? "" : " + ") + words_for(s);
}

}  // namespace

std::string full_type_name(const std::string& present_type, const std::string& written)
{
    if (written.find('/') != std::string::npos) return written;
    return present_type.substr(0, present_type.rfind('/') + 1) + written;
}

Result<std::vector<Setting>> parse_vary(const std::string& text)
{
    const std::size_t equal = text.find('=');
    if (equal == std::string::npos || equal == 0 || equal + 1 == text.size())
        return reason("--vary needs ID=TypeA,TypeB, ID.param=v1,v2 or dt=1/30,1/60, not '" + text + "'");
    std::vector<Setting> out;
    for (std::string& value : split(std::string_view(text).substr(equal + 1), ','))
    {
        if (value.empty()) return reason("--vary: an empty value in '" + text + "'");
        out.push_back({std::string(model::trimmed(text.substr(0, equal))), std::move(value)});
    }
    return out;
}

Result<Algorithm> parse_algorithm(const std::string& text)
{
    Algorithm out;
    std::string_view rest = text;
    if (const std::size_t colon = rest.find(':');
        colon != std::string_view::npos && rest.substr(0, colon).find('=') == std::string_view::npos)
        out.name = model::trimmed(rest.substr(0, colon)), rest.remove_prefix(colon + 1);
    for (const std::string_view word : model::split_words(rest))
    {
        const std::size_t equal = word.find('=');
        if (equal == std::string_view::npos || equal == 0 || equal + 1 == word.size())
            return reason("--algorithm needs [NAME:] ID=Type ID.param=value ..., not '" + std::string(word) + "'");
        out.settings.push_back({std::string(word.substr(0, equal)), std::string(word.substr(equal + 1))});
    }
    if (out.settings.empty() && out.name.empty()) return reason("--algorithm is empty: it needs [NAME:] ID=Type ID.param=value ...");
    return out;
}

Result<void> check_settings(const std::vector<Algorithm>& algorithms, const std::vector<std::vector<Setting>>& varied)
{
    std::set<std::string> targets;
    for (const std::vector<Setting>& v : varied)
    {
        if (!targets.insert(v.front().target).second)
            return reason("--vary " + v.front().target + " is given twice: write all values in one, as --vary dt=1/60,1/120");
        for (std::size_t i = 0; i < v.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                if (same_value(v[i], v[k]))
                    return reason("--vary " + v[i].target + ": '" + v[k].value + "' and '" + v[i].value +
                                  "' are the same value, given twice");
    }
    for (const Algorithm& algorithm : algorithms)
    {
        std::set<std::string> own;
        for (const Setting& s : algorithm.settings)
        {
            if (!own.insert(s.target).second) return reason("--algorithm sets " + s.target + " twice, to '" + s.value + "' as well");
            if (targets.contains(s.target)) return reason(s.target + " is set by --algorithm and varied by --vary: use only one of them");
        }
    }
    std::set<std::string> names;
    for (const Combination& c : combine(algorithms, varied))
        if (!names.insert(c.label()).second)
            return reason("two runs would have the name '" + c.label() +
                          "': give algorithms names of their own, as in --algorithm \"NAME: ID=Type\"");
    return {};
}

std::vector<Combination> combine(const std::vector<Algorithm>& algorithms, const std::vector<std::vector<Setting>>& varied)
{
    std::vector<Combination> out;
    for (const Algorithm& algorithm : algorithms)
    {
        Combination c;
        for (const Setting& s : algorithm.settings) add_setting(c, s);
        if (!algorithm.name.empty()) c.algorithm = algorithm.name;
        out.push_back(std::move(c));
    }
    if (out.empty()) out.emplace_back();
    std::vector<const std::vector<Setting>*> order;
    for (const auto& v : varied)
        if (!v.front().is_dt()) order.push_back(&v);
    for (const auto& v : varied)
        if (v.front().is_dt()) order.push_back(&v);
    for (const auto* choices : order)
    {
        std::vector<Combination> next;
        for (const Combination& c : out)
            for (const Setting& s : *choices)
            {
                next.push_back(c);
                add_setting(next.back(), s);
            }
        out = std::move(next);
    }
    for (Combination& c : out)
        if (c.algorithm.empty()) c.algorithm = "as written";
    return out;
}

Result<model::SceneSpec> apply(const model::SceneSpec& scene, model::TypeSource& types, const std::vector<Setting>& settings)
{
    model::SceneSpec out = scene;
    // Types first: a parameter may be one that only the new type has.
    const auto is_type = [&](const Setting& s) { return !s.is_dt() && find(out, s.target) != out.components.size(); };
    for (const bool wanted : {true, false})
        for (const Setting& s : settings)
            if (is_type(s) == wanted)
                if (auto done = apply_one(out, types, s); !done) return done.errors();
    return out;
}

Result<model::StepLength> common_instants(const std::vector<model::StepLength>& lengths)
{
    model::StepLength out = lengths.front();
    for (const model::StepLength& l : lengths)
    {
        if (l.denominator == 0 || out.denominator == 0)
            return reason("a step length is not a fraction of whole numbers: write it as 1/240 or 0.001");
        // lcm of a/b and c/d in lowest terms: lcm(a, c) / gcd(b, d).
        const std::int64_t share = out.numerator / std::gcd(out.numerator, l.numerator);
        if (__builtin_mul_overflow(share, l.numerator, &out.numerator)) return reason("the step lengths have no common instants");
        out.denominator = std::gcd(out.denominator, l.denominator);
        out.seconds = static_cast<double>(out.numerator) / static_cast<double>(out.denominator);
    }
    return out;
}

}  // namespace plab::study
