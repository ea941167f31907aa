#include "study/quantity.h"

#include <algorithm>
#include <cmath>

#include "model/names.h"
#include "model/type_summary.h"
#include "model/values.h"

namespace plab::study
{
namespace
{

using model::number_count;

/// "z" of "position.z", "2" of "values.2": its place among the numbers of a vector, an attitude or a list.
std::optional<std::size_t> part_of(const std::string& name, const Value& whole)
{
    const std::vector<std::string> suffixes = model::number_suffixes(whole);
    const auto found = std::find(suffixes.begin(), suffixes.end(), "." + name);
    return found == suffixes.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - suffixes.begin()));
}

std::vector<std::string> numbers_of(const world::World& world, std::uint32_t owner)
{
    std::vector<std::string> names;
    if (const model::ComponentType* type = world.type_of(owner))
        for (const Field& f : type->schema.fields())
            if (number_count(world.get(owner, f.name)) > 0) names.push_back(f.name);
    return names;
}

std::vector<std::string> ids_of(const world::World& world)
{
    std::vector<std::string> ids;
    for (const std::uint32_t i : world.in_id_order()) ids.push_back(world.id_of(i));
    return ids;
}

Error unknown_field(const world::World& world, std::uint32_t owner, const std::string& text, const std::string& field)
{
    const std::vector<std::string> names = numbers_of(world, owner);
    const std::string id = world.id_of(owner), at = "quantity '" + text + "': ";
    if (names.empty()) return reason(at + id + " has no field that is a number");
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    if (field.empty())
        return reason(at + "does not name a field of " + id + ": write ID.field, such as " + id + "." + names.front() + "; it has " + all);
    std::string near = model::did_you_mean(field, names);
    // Perhaps the name of a part of it was meant: contact.respnse.sweeps.
    if (near.empty() && field.find('.') != std::string::npos) near = model::did_you_mean(text.substr(0, text.rfind('.')), ids_of(world));
    return reason(at + id + " has no number '" + field + "'" + near + "; it has " + all);
}

Error unknown_owner(const world::World& world, const std::string& text)
{
    if (const std::uint32_t whole = world.find(text); whole != kNoIndex) return unknown_field(world, whole, text, "");
    const std::vector<std::string> ids = ids_of(world);
    // An id may have dots: the longest prefix that resembles an id is the most informative.
    std::string near;
    for (std::size_t dot = text.rfind('.'); near.empty() && dot != std::string::npos && dot > 0; dot = text.rfind('.', dot - 1))
        near = model::did_you_mean(text.substr(0, dot), ids);
    if (text.find('.') == std::string::npos) near = model::did_you_mean(text, ids);
    return reason("quantity '" + text + "': no component has this id" + near + "; write ID.field, such as ball.position");
}

bool finite(std::span<const double> v)
{
    return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

Result<Quantity> resolve_quantity(const world::World& world, const std::string& text)
{
    Quantity q;
    q.name = text;
    const auto [id, field_name] = split_id(text, [&](const std::string& name) { return world.find(name) != kNoIndex; });
    if (id.empty()) return unknown_owner(world, text);
    const std::uint32_t owner = world.find(id);
    q.id = id, q.field = field_name;
    Value value = world.get(owner, q.field);
    if (number_count(value) == 0)
    {
        const std::size_t dot = q.field.rfind('.');
        const Value whole = dot == std::string::npos ? Value() : world.get(owner, q.field.substr(0, dot));
        q.part = dot == std::string::npos ? std::nullopt : part_of(q.field.substr(dot + 1), whole);
        if (!q.part) return unknown_field(world, owner, text, q.field);
        q.field.resize(dot), value = whole;
    }
    q.width = q.part ? 1 : number_count(value);
    q.suffixes = model::number_suffixes(value);
    q.measure = !q.part && type_of(value) == FieldType::Rotation ? Measure::Geodesic : Measure::Mixed;
    const model::ComponentType* type = world.type_of(owner);
    const Field* field = type ? type->schema.find_field(q.field) : nullptr;
    q.unit = q.measure == Measure::Geodesic ? "rad" : field ? std::string(field->unit.symbol) : "";
    return q;
}

std::string Quantity::column(std::size_t i) const { return width == 1 ? name : name + suffixes[i]; }

std::vector<std::string> default_quantities(const world::World& world, std::size_t most)
{
    std::vector<std::string> out;
    for (const std::uint32_t i : world.in_id_order())
    {
        const world::Component& c = world.component(i);
        if (out.size() >= most) break;
        if (c.facet == Facet::Body && world.host().bodies.dynamic(c.host_index)) out.push_back(c.id + ".position");
        if (c.facet == Facet::Shaft && world.host().shafts.dynamic(c.host_index)) out.push_back(c.id + ".angle");
        if (c.facet == Facet::Quantities) out.push_back(c.id + ".values");
    }
    return out;
}

void read(const world::World& world, const Quantity& quantity, std::vector<double>& out)
{
    const std::size_t before = out.size();
    const std::uint32_t i = world.find(quantity.id);
    if (i != kNoIndex)
    {
        model::append_numbers(world.get(i, quantity.field), out);
        if (quantity.part && before + *quantity.part < out.size()) out[before] = out[before + *quantity.part];
    }
    out.resize(before + quantity.width, kNaN);
}

double scale_of(const TimeSeries& reference)
{
    double travel = 0, largest = 0;
    for (std::size_t i = 0; i < reference.values.size(); ++i)
    {
        travel = std::max(travel, std::fabs(reference.values[i] - reference.values[i % reference.width]));
        largest = std::max(largest, std::fabs(reference.values[i]));
    }
    return travel > 0 ? travel : largest > 0 ? largest : 1.0;
}

double attitude_angle(std::span<const double> q, std::span<const double> r)
{
    const Quat d = conjugate(Quat{r[0], r[1], r[2], r[3]}) * Quat{q[0], q[1], q[2], q[3]};
    return 2 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::fabs(d.w));
}

double absolute_distance_at(const Quantity& quantity, std::span<const double> y, std::span<const double> r)
{
    if (!finite(y) || !finite(r)) return kNaN;
    if (quantity.measure == Measure::Geodesic) return attitude_angle(y, r);
    double worst = 0;
    for (std::size_t i = 0; i < y.size(); ++i) worst = std::max(worst, std::fabs(y[i] - r[i]));
    return worst;
}

double distance_at(const Quantity& quantity, std::span<const double> y, std::span<const double> r, double scale)
{
    if (!finite(y) || !finite(r)) return kNaN;
    if (quantity.measure == Measure::Geodesic) return attitude_angle(y, r);
    double worst = 0;
    for (std::size_t i = 0; i < y.size(); ++i) worst = std::max(worst, std::fabs(y[i] - r[i]) / (scale + std::fabs(r[i])));
    return worst;
}

Distance distance(const Quantity& quantity, const TimeSeries& series, const TimeSeries& reference, double scale)
{
    Distance out;
    const std::size_t n = std::min(series.samples(), reference.samples());
    if (n == 0 || series.samples() < reference.samples()) out.last = out.last_absolute = kNaN;
    if (n == 0) out.series = out.series_absolute = kNaN;
    for (std::size_t i = 0; i < n; ++i)
    {
        const double mixed = distance_at(quantity, series.at(i), reference.at(i), scale);
        const double absolute = absolute_distance_at(quantity, series.at(i), reference.at(i));
        // NaN is kept: a run that was invalid at one sample is invalid.
        out.series = mixed > out.series || std::isnan(mixed) ? mixed : out.series;
        out.series_absolute = absolute > out.series_absolute || std::isnan(absolute) ? absolute : out.series_absolute;
        if (i + 1 == n && n == reference.samples() && n == series.samples()) out.last = mixed, out.last_absolute = absolute;
    }
    return out;
}

}  // namespace plab::study
