#include "control/recording/analysis/signal.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>

#include "link/names.h"

namespace plab::analysis
{
namespace
{

using Source = Signal::Source;

struct Field
{
    std::string_view name, unit;
    std::string_view components;  ///< "xyz", "wxyz", or "" for a number
    std::string_view same_as;     ///< "" or the name of which it is an alias
};

constexpr std::array<Field, 7> kObjectFields{{
    {"position", "m", "xyz", ""},
    {"orientation", "", "wxyz", ""},
    {"linear_velocity", "m/s", "xyz", ""},
    {"velocity", "m/s", "xyz", "linear_velocity"},
    {"angular_velocity", "rad/s", "xyz", ""},
    {"speed", "m/s", "", ""},
    {"angle", "rad", "", ""},
}};
constexpr const char* kOfBody = "a body has position, orientation, linear_velocity, angular_velocity, speed";
constexpr const char* kOfShaft = "a shaft has angle, speed";
bool is_of_shaft(const Field& field) { return field.name == "angle" || field.name == "speed"; }
constexpr std::array<Field, 3> kInteractionFields{{{"cost", "ns", "", ""}, {"error", "", "", ""}, {"work", "J", "", ""}}};
constexpr std::array<Field, 13> kSceneFields{{
    {"energy.kinetic", "J", "", ""},
    {"energy.stored", "J", "", ""},
    {"energy.total", "J", "", ""},
    {"energy.work", "J", "", ""},
    {"energy.of_requests", "J", "", ""},
    {"energy.unexplained", "J", "", ""},
    {"momentum", "N s", "xyz", ""},
    {"angular_momentum", "N m s", "xyz", ""},
    {"real_time_factor", "", "", ""},
    {"step_cost", "ns", "", ""},
    {"contacts", "", "", ""},
    {"deepest", "m", "", ""},
    {"residual", "m/s", "", ""},
}};

/// The field that `text` names, with the component after it; null if it names none.
struct Named
{
    const Field* field = nullptr;
    std::string component;
};
Named named(std::span<const Field> fields, std::string_view text)
{
    for (const Field& field : fields)
    {
        if (field.name.empty() || !text.starts_with(field.name)) continue;
        const std::string_view rest = text.substr(field.name.size());
        if (rest.empty()) return {&field, ""};
        if (rest == ".norm" && field.components == "xyz") return {&field, "norm"};
        if (rest.size() == 2 && rest[0] == '.' && field.components.find(rest[1]) != std::string_view::npos)
            return {&field, std::string(rest.substr(1))};
    }
    return {};
}

std::string unit_of(const Field& field, bool is_shaft) { return is_shaft && field.name == "speed" ? "rad/s" : std::string(field.unit); }

/// A vector without a component stands for all of its components.
std::vector<Signal> spread(Source source, const std::string& id, const Named& what, bool is_shaft)
{
    const Field& field = *what.field;
    Signal q{source, id, std::string(field.same_as.empty() ? field.name : field.same_as), what.component, unit_of(field, is_shaft)};
    if (!what.component.empty() || field.components.empty()) return {q};
    std::vector<Signal> out;
    for (const char c : field.components)
    {
        q.component = std::string(1, c);
        out.push_back(q);
    }
    return out;
}

IdAndRest split_id_of(const std::string& text, const std::vector<std::string>& ids)
{
    return split_id(text, [&](const std::string& id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); });
}

std::string names_of(std::span<const Field> fields)
{
    std::string out;
    for (const Field& field : fields)
        if (!field.name.empty() && field.same_as.empty()) out += (out.empty() ? "" : ", ") + std::string(field.name);
    return out;
}

/// "cost", or an output: "force", "force.x".
std::vector<Signal> of_interaction(const std::string& id, const std::string& what)
{
    if (const Named field = named(kInteractionFields, what); field.field != nullptr) return spread(Source::Interaction, id, field, false);
    Signal q{Source::Interaction, id, what, "", ""};
    const std::size_t n = what.size();
    if (n > 2 && what[n - 2] == '.' && std::string_view("xyz").find(what[n - 1]) != std::string_view::npos)
        q.what = what.substr(0, n - 2), q.component = what.substr(n - 1);
    return {q};
}

Error unknown(const std::string& text, const Things& things)
{
    std::vector<std::string> known = things.objects();
    for (const std::string& id : things.interactions()) known.push_back(id);
    const std::string id = text.substr(0, text.find('.'));
    return reason("no quantity '" + text + "': it does not begin with the id of an object or interaction" + link::did_you_mean(id, known) +
                  "; quantities of the scene are " + names_of(kSceneFields));
}

double component_of(const std::string& component, const plab_v2_Vector& v)
{
    if (component == "norm") return norm(v);
    return component == "x" ? v.x : (component == "y" ? v.y : v.z);
}

double component_of(const std::string& component, const plab_v2_Rotation& q)
{
    if (component == "w") return q.w;
    return component == "x" ? q.x : (component == "y" ? q.y : q.z);
}

std::optional<double> scene_value(const Signal& q, const plab_v2_Metrics& m)
{
    const plab_v2_EnergyLedger& e = m.ledger;
    if (q.what == "momentum") return component_of(q.component, m.momentum);
    if (q.what == "angular_momentum") return component_of(q.component, m.angular_momentum);
    const std::array<std::pair<std::string_view, double>, 11> values{{{"energy.kinetic", e.kinetic},
                                                                      {"energy.stored", e.stored},
                                                                      {"energy.total", e.kinetic + e.stored},
                                                                      {"energy.work", e.work},
                                                                      {"energy.of_requests", e.of_requests},
                                                                      {"energy.unexplained", e.unexplained},
                                                                      {"real_time_factor", m.real_time_factor},
                                                                      {"step_cost", m.step_ns},
                                                                      {"contacts", m.contacts},
                                                                      {"deepest", m.deepest},
                                                                      {"residual", m.residual}}};
    for (const auto& [name, value] : values)
        if (name == q.what) return value;
    return {};
}

const plab_v2_InteractionMetrics* find(const plab_v2_Metrics& m, const std::string& id)
{
    for (std::uint32_t i = 0; i < m.interactions._length; ++i)
        if (id == m.interactions._buffer[i].component_id) return &m.interactions._buffer[i];
    return nullptr;
}

const plab_v2_Parameter* find_output(const plab_v2_InteractionMetrics& m, const std::string& name)
{
    for (std::uint32_t i = 0; i < m.outputs._length; ++i)
        if (name == m.outputs._buffer[i].name) return &m.outputs._buffer[i];
    return nullptr;
}

/// "4", "(1 2 2)": the numbers in a text, three at the most.
std::vector<double> numbers_in(std::string_view text)
{
    std::vector<double> out;
    for (std::size_t at = 0; at < text.size() && out.size() < 3;)
    {
        double value = 0;
        const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
        if (error == std::errc()) out.push_back(value);
        at = error == std::errc() ? static_cast<std::size_t>(end - text.data()) : at + 1;
    }
    return out;
}

/// The length of a vector, unless a component is named.
std::optional<double> output_value(const Signal& q, const plab_v2_Parameter& output)
{
    const std::string_view text = output.text;
    if (text == "true" || text == "false") return text == "true" ? 1.0 : 0.0;
    const std::vector<double> numbers = numbers_in(text);
    if (numbers.size() == 3)
    {
        const plab_v2_Vector v{numbers[0], numbers[1], numbers[2]};
        return component_of(q.component.empty() ? "norm" : q.component, v);
    }
    return numbers.size() == 1 && q.component.empty() ? std::optional(numbers[0]) : std::nullopt;
}

}  // namespace

double norm(const plab_v2_Vector& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

std::string Signal::name() const { return id + (id.empty() ? "" : ".") + what + (component.empty() ? "" : ".") + component; }

std::vector<std::string> signal_names(const Things& things)
{
    std::vector<std::string> out;
    for (const std::string& id : things.objects())
        for (const Field& field : kObjectFields)
            if (field.same_as.empty() && (field.name == "speed" || is_of_shaft(field) == things.is_shaft(id)))
                out.push_back(id + "." + std::string(field.name));
    for (const std::string& id : things.interactions())
        for (const Field& field : kInteractionFields) out.push_back(id + "." + std::string(field.name));
    for (const Field& field : kSceneFields) out.emplace_back(field.name);
    return out;
}

Result<std::vector<Signal>> parse_signal(const std::string& text, const Things& things)
{
    auto [id, rest] = split_id_of(text, things.objects());
    // Without a catalogue, objects are identified by numbers.
    if (const std::size_t dot = text.find('.'); id.empty() && text.starts_with('#') && dot != std::string::npos)
        id = text.substr(0, dot), rest = text.substr(dot + 1);
    if (!id.empty())
    {
        const Named what = named(kObjectFields, rest);
        // An object that is not in the catalogue may be either.
        const std::vector<std::string> all = things.objects();
        const bool is_known = std::find(all.begin(), all.end(), id) != all.end(), is_shaft = things.is_shaft(id);
        const bool has_field = what.field != nullptr && (!is_known || (is_shaft ? is_of_shaft(*what.field) : what.field->name != "angle"));
        if (!has_field)
            return reason("no quantity '" + text + "': " +
                          (is_known && is_shaft ? kOfShaft
                           : is_known           ? kOfBody
                                                : kOfBody + std::string("; ") + kOfShaft));
        return spread(Source::Object, id, what, is_shaft);
    }
    if (auto [owner, field] = split_id_of(text, things.interactions()); !owner.empty()) return of_interaction(owner, field);
    if (const Named what = named(kSceneFields, text); what.field != nullptr) return spread(Source::Scene, "", what, false);
    const std::size_t dot = text.rfind('.');
    if (things.interactions().empty() && dot != std::string::npos && dot > 0)
        return of_interaction(text.substr(0, dot), text.substr(dot + 1));
    return unknown(text, things);
}

std::optional<double> value_of(const Signal& q, const plab_v2_BodyState& b)
{
    if (q.what == "position") return component_of(q.component, b.position);
    if (q.what == "orientation") return component_of(q.component, b.orientation);
    if (q.what == "linear_velocity") return component_of(q.component, b.linear_velocity);
    if (q.what == "angular_velocity") return component_of(q.component, b.angular_velocity);
    return q.what == "speed" ? std::optional(norm(b.linear_velocity)) : std::nullopt;
}

std::optional<double> value_of(const Signal& q, const plab_v2_ShaftState& s)
{
    if (q.what == "angle") return s.angle;
    return q.what == "speed" ? std::optional(s.speed) : std::nullopt;
}

bool is_measured(const Signal& q) { return q.what == "cost" || q.what == "step_cost" || q.what == "real_time_factor"; }

std::optional<double> value_of(const Signal& q, const plab_v2_Metrics& m)
{
    if (is_measured(q) && m.step_ns == 0) return {};
    if (q.source == Source::Scene) return scene_value(q, m);
    const plab_v2_InteractionMetrics* const i = find(m, q.id);
    if (i == nullptr) return {};
    if (q.what == "cost") return i->cost_ns;
    if (q.what == "error") return i->error;
    if (q.what == "work") return i->work;
    const plab_v2_Parameter* const output = find_output(*i, q.what);
    return output == nullptr ? std::nullopt : output_value(q, *output);
}

std::string unit_in(const Signal& q, const plab_v2_Metrics& m)
{
    const plab_v2_InteractionMetrics* const i = find(m, q.id);
    const plab_v2_Parameter* const output = i == nullptr ? nullptr : find_output(*i, q.what);
    return output == nullptr ? "" : output->unit;
}

}  // namespace plab::analysis
