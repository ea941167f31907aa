#include "simulation/levels/ladder.h"

#include <algorithm>

#include "model/ladders.h"
#include "model/names.h"
#include "model/text.h"
#include "model/values.h"

namespace plab::simulation
{
namespace
{

Error bad_level(std::string_view level, const std::string& why) { return reason("level " + model::quoted(level) + ": " + why); }

/// "substeps=4" of a level of this type.
Result<NamedValue> read_value(std::string_view word, const model::ComponentType& type)
{
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos) return reason("expected NAME=VALUE instead of " + model::quoted(word));
    const std::string name(word.substr(0, equals));
    const Field* field = type.schema.find_field(name);
    if (!field || field->kind != FieldKind::Param)
    {
        std::vector<std::string> names;
        for (const Field& f : type.schema.fields())
            if (f.kind == FieldKind::Param) names.push_back(f.name);
        return reason(type.info.name + " has no parameter " + model::quoted(name) + model::did_you_mean(name, names));
    }
    auto value = model::parse_value(word.substr(equals + 1), *field);
    if (!value) return reason(name + ": " + value.error().reason);
    return NamedValue{name, value.take()};
}

Result<Level> read_level(std::string_view text, model::TypeSource& types)
{
    Level out;
    const std::vector<std::string_view> words = model::split_words(text);
    if (words.empty()) return bad_level(text, "is empty");
    auto type = types.require(std::string(words.front()));
    if (!type) return bad_level(text, type.error().reason);
    out.type = (*type)->info.name, out.text = out.type;
    for (std::size_t k = 1; k < words.size(); ++k)
    {
        auto value = read_value(words[k], **type);
        if (!value) return bad_level(text, value.error().reason);
        out.values.push_back(value.take());
        out.text += " " + std::string(words[k]);
    }
    return out;
}

std::string written_ladder(std::string_view text)
{
    std::string out;
    if (text.find(';') == std::string_view::npos && text.find('=') == std::string_view::npos)
        for (const std::string& type : model::default_ladder(model::trimmed(text))) out += (out.empty() ? "" : "; ") + type;
    return out.empty() ? std::string(text) : out;
}

}  // namespace

Result<Ladder> read_ladder(std::string_view text, model::TypeSource& types)
{
    Ladder out;
    const std::string whole = written_ladder(text);
    for (std::string_view rest = whole; !rest.empty();)
    {
        const std::size_t end = std::min(rest.find(';'), rest.size());
        const std::string_view one = model::trimmed(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (one.empty() && rest.empty()) break;  // a semicolon at the end
        auto level = read_level(one, types);
        if (!level) return level.errors();
        const std::string& family = (*types.require(level->type))->info.family;
        if (out.levels.empty()) out.family = family;
        if (family != out.family) return bad_level(one, "is of the family " + family + ", the first level is of " + out.family);
        out.levels.push_back(level.take());
    }
    if (out.levels.size() < 2)
        return reason("a ladder needs at least two levels, separated by ';', or the name of a family that has an order");
    return out;
}

std::int32_t level_of(const world::World& world, std::uint32_t component, const Ladder& ladder)
{
    const model::ComponentType* type = world.type_of(component);
    for (std::size_t k = 0; type && k < ladder.levels.size(); ++k)
    {
        const Level& level = ladder.levels[k];
        const auto has = [&](const NamedValue& v) { return world.get(component, v.name) == std::get<Value>(v.value); };
        if (level.type == type->info.name && std::all_of(level.values.begin(), level.values.end(), has))
            return static_cast<std::int32_t>(k);
    }
    return -1;
}

bool matches_any(std::string_view patterns, std::string_view id)
{
    for (const std::string_view pattern : model::split_words(patterns))
        if (model::matches(pattern, id)) return true;
    return false;
}

}  // namespace plab::simulation
