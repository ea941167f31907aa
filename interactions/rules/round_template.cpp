// What a template knows of a pair, and the blueprints that a rule asks for.
#include "round.h"
#include "template_text.h"

namespace plab::rules
{

std::optional<Value> Round::known_of(const Site& site, std::string_view name) const
{
    if (name == "radius" && site.radius > 0) return Value(site.radius);
    if (name == "connector") return Value(std::string(lookup_.id_of(site.component)));
    const Ref shape = lookup_.participant(lookup_.component_of(site.object), "shape");
    for (const Ref source : {site.connector, site.object, shape})
        if (source.valid())
            if (Value value = lookup_.value_of(source, name); type_of(value) != FieldType::None) return value;
    return {};
}

std::optional<Value> Round::known(Row row, const Pair& pair, std::string_view name) const
{
    const Memory& memory = *rules_.memory[row];
    const Site &a = memory.sites[pair.a], &b = memory.sites[pair.b];
    if (name == "a") return Value(std::string(lookup_.id_of(a.object)));
    if (name == "b") return Value(std::string(lookup_.id_of(b.object)));
    if (name == "rule") return Value(std::string(lookup_.id_of(scene_.context.component_of_row[row])));
    if (name == "distance") return Value(pair.measures.distance);
    if (name == "along") return Value(pair.measures.along);
    if (name == "radial") return Value(pair.measures.radial);
    if (name == "angle") return Value(pair.measures.angle);
    const Place at_a = place_of(a, scene_.bodies, scene_.shafts);
    // +1: the axes point the same way; -1: opposite ways.
    if (name == "sense")
        return Value(dot(rotate(at_a.X.q, {0, 0, 1}), rotate(place_of(b, scene_.bodies, scene_.shafts).X.q, {0, 0, 1})) < 0 ? -1.0 : 1.0);
    if (name == "point") return Value(at_a.X.p);
    if (name == "axis") return Value(rotate(at_a.X.q, {0, 0, 1}));
    if (name.starts_with("a.")) return known_of(a, name.substr(2));
    if (name.starts_with("b.")) return known_of(b, name.substr(2));
    for (const Entry& entry : pair.values)
        if (entry.name == name) return std::visit([](const auto& v) { return Value(v); }, entry.value);
    return {};
}

Result<std::string> Round::blueprint_for(const Pair& pair) const
{
    return fill_template(rules_.text[row_], [&](std::string_view name) { return known(row_, pair, name); });
}

std::string Round::drawing_for(const Pair& pair, const std::string& id) const
{
    const Site &a = memory_.sites[pair.a], &b = memory_.sites[pair.b];
    const auto filled = [&](std::string_view name) -> std::optional<Value>
    {
        if (name == "id") return Value(id + ".draw");
        if (name == "type") return Value(rules_.draw_by[row_]);
        if (name == "point_a") return Value(a.offset.p);
        if (name == "point_b") return Value(b.offset.p);
        if (name == "frame_a") return Value(a.offset.q);
        if (name == "frame_b") return Value(b.offset.q);
        if (name == "frequency") return Value(rules_.draw[row_]);
        if (name == "turns") return Value(rules_.turns[row_]);
        return known(row_, pair, name);
    };
    return fill_template(
               "<plab version=\"1\"><component id=\"${id}\" type=\"${type}\" a=\"${a}\" b=\"${b}\" point_a=\"${point_a}\" "
               "point_b=\"${point_b}\" frame_a=\"${frame_a}\" frame_b=\"${frame_b}\" frequency=\"${frequency}\" "
               "turns=\"${turns}\"/></plab>",
               filled)
        .take();
}

Couplings Round::find_couplings() const
{
    Couplings out;
    for (Row row = 0; row < scene_.context.component_of_row.size(); ++row)
    {
        if (scene_.context.component_of_row[row] == kNoIndex || !rules_.memory[row] || rules_.couples[row].empty()) continue;
        const Memory& memory = memory_of(row);
        for (const Link& link : memory.links)
        {
            if (link.progress != Progress::Made || link.site_a == kNoIndex || link.site_b == kNoIndex) continue;
            const Pair pair{link.site_a, link.site_b, measures_of(memory, link.site_a, link.site_b), {}};
            const auto ratio = number_of(rules_.couples[row], [&](std::string_view name) { return known(row, pair, name); });
            if (ratio && *ratio != 0) out.add({memory.sites[link.site_a].object, memory.sites[link.site_b].object, *ratio, link.id});
        }
    }
    return out;
}

std::string Round::couple(const Pair& pair, const std::string& id)
{
    if (rules_.couples[row_].empty()) return {};
    const auto ratio = number_of(rules_.couples[row_], [&](std::string_view name) { return known(row_, pair, name); });
    if (!ratio) return ratio.error().reason;
    if (*ratio == 0) return "couples must not be zero";
    if (!couplings_) couplings_ = find_couplings();
    const Ref a = memory_.sites[pair.a].object, b = memory_.sites[pair.b].object;
    const auto present = couplings_->ratio(a, b);
    if (!present || agree(*present, *ratio))
    {
        couplings_->add({a, b, *ratio, id});
        return {};
    }
    const auto path = couplings_->path(a, b);
    const std::string name_a(lookup_.id_of(a)), name_b(lookup_.id_of(b));
    return "a loop that cannot turn: " + name_b + " would make " + in_digits(*ratio) + " turns per turn of " + name_a + ", but makes " +
           in_digits(*present) + " by " + path->ids;
}

void apply_rules(const StepContext& context, Rows rows, RuleRows& rules, const Bodies& bodies, const Shafts& shafts,
                 const Quantities& quantities, RequestSink& requests)
{
    const Scene scene{context, bodies, shafts, quantities};
    for (const Row row : rows) Round(scene, row, rules, requests).run();
}

}  // namespace plab::rules
