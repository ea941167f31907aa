#include "control/live/watch_print.h"

#include <nlohmann/json.hpp>

#include "control/console/table.h"
#include "control/live/metrics_text.h"

namespace plab::cli
{
namespace
{

std::string four_decimals(double value)
{
    char buffer[64];
    return {buffer, static_cast<std::size_t>(std::snprintf(buffer, sizeof buffer, "%.4f", value))};
}

std::string padded(std::string text, std::size_t width)
{
    const std::size_t columns = columns_of(text);
    return columns < width ? text + std::string(width - columns, ' ') : text;
}

Vec3 vector(const plab_v2_Vector& v) { return {v.x, v.y, v.z}; }

std::string name_of(std::uint32_t handle, const link::Catalogue& catalogue)
{
    const link::Object* const object = catalogue.find_object(handle);
    return object != nullptr ? object->component_id : "#" + std::to_string(handle);
}

Json frame_json(const Frame& f, const std::map<std::string, const Motion*>& motions)
{
    Json bodies = Json::object(), shafts = Json::object();
    for (const auto& [id, motion] : motions) (motion->is_shaft ? shafts : bodies)[id] = json_of(*motion);
    return {{"run", f.run},     {"revision", f.revision}, {"sequence_number", f.number},
            {"step", f.step},   {"time", f.time},         {"stamp_ns", f.stamp_ns},
            {"bodies", bodies}, {"shafts", shafts}};
}

Table motion_table(const std::map<std::string, const Motion*>& motions)
{
    Table table({{"object", Align::Left, Shrink::Middle},
                 {"x", Align::Right},
                 {"y", Align::Right},
                 {"z", Align::Right},
                 {"vx", Align::Right, Shrink::Never, 2},
                 {"vy", Align::Right, Shrink::Never, 2},
                 {"vz", Align::Right, Shrink::Never, 3},
                 {"angle", Align::Right, Shrink::Never, 4},
                 {"speed", Align::Right, Shrink::Never, 1}});
    for (const auto& [id, m] : motions)
        if (m->is_shaft)
            table.add({id, "", "", "", "", "", "", four_decimals(m->angle), four_decimals(m->speed)});
        else
            table.add({id, four_decimals(m->position.x), four_decimals(m->position.y), four_decimals(m->position.z),
                       four_decimals(m->linear_velocity.x), four_decimals(m->linear_velocity.y), four_decimals(m->linear_velocity.z), "",
                       ""});
    return table;
}

std::string when(std::int64_t step, double time) { return "step " + std::to_string(step) + "  " + four_decimals(time) + " s"; }

/// The algorithm that does the work; the server's explanation is shown by `interactions` and in JSON.
std::string algorithm_of(const link::InteractionMetrics& i)
{
    return i.resolved.empty() || i.resolved.starts_with(i.requested) ? i.requested : i.resolved;
}

std::string remark(const wire::ContactInfo& pair, const wire::ContactPoint& point)
{
    return pair.asleep ? "asleep" : point.is_impact ? "impact" : "";
}

/// One line for each point.
Table contact_table(const wire::ContactForces& contacts)
{
    Table table({{"a", Align::Left, Shrink::Middle},
                 {"b", Align::Left, Shrink::Middle},
                 {"x", Align::Right},
                 {"y", Align::Right},
                 {"z", Align::Right},
                 {"normal N", Align::Right},
                 {"friction N", Align::Right},
                 {"depth m", Align::Right, Shrink::Never, 1},
                 {"remark", Align::Left}});
    for (const wire::ContactInfo& pair : contacts.entries)
        for (const wire::ContactPoint& p : pair.points)
            table.add({pair.a, pair.b, four_decimals(p.position.x), four_decimals(p.position.y), four_decimals(p.position.z),
                       number(p.normal_force), number(length(p.friction_force)), number(p.depth), remark(pair, p)});
    return table;
}

Style style_of(std::string_view severity)
{
    return severity == "failure" ? Style::Red : severity == "warning" ? Style::Yellow : Style::Plain;
}

}  // namespace

void WatchPrinter::frame(const Frame& frame, const link::Catalogue& catalogue)
{
    std::map<std::string, const Motion*> motions;
    for (const auto& [handle, motion] : frame.motions)
        if (const std::string id = name_of(handle, catalogue); selection_.takes(id)) motions[id] = &motion;
    if (json_) return print(console_, frame_json(frame, motions));
    console_.out(console_.styled(Style::Bold, when(frame.step, frame.time)) + "\n");
    motion_table(motions).print(console_, !has_title_);
    has_title_ = true;
}

void WatchPrinter::metrics(const link::Metrics& metrics)
{
    link::Metrics m = metrics;
    std::erase_if(m.interactions, [&](const link::InteractionMetrics& i) { return !selection_.takes(i.component_id); });
    if (json_) return print(console_, json_of(m));
    console_.out(console_.styled(Style::Bold, when(m.step, m.time)) + "  " +
                 (m.real_time_factor > 0 ? number(m.real_time_factor) + "x  " : "") + (m.step_ns > 0 ? duration_text(m.step_ns) : "-") +
                 " a step  kinetic " + number(m.ledger.kinetic) + " J  stored " + number(m.ledger.stored) + " J  unexplained " +
                 number(m.ledger.unexplained) + " J  " + std::to_string(m.contacts) + " contacts  deepest " + number(m.deepest) + " m\n");
    Table table({{"interaction", Align::Left, Shrink::Middle},
                 {"algorithm", Align::Left, Shrink::Middle},
                 {"cost/step", Align::Right},
                 {"error", Align::Right, Shrink::Never, 2},
                 {"unit", Align::Left, Shrink::Never, 2},
                 {"work", Align::Right, Shrink::Never, 3},
                 {"state"}});
    for (const link::InteractionMetrics& i : m.interactions)
        table.add({i.component_id, algorithm_of(i), cost_text(i), error_text(i), error_unit(i), number(i.work) + " J",
                   i.quarantined ? "quarantined" : ""},
                  i.quarantined ? Style::Red : Style::Plain);
    table.print(console_, !has_title_);
    has_title_ = true;
}

void WatchPrinter::contacts(wire::ContactForces c)
{
    std::erase_if(c.entries, [&](const wire::ContactInfo& e)
                  { return !selection_.takes(e.a) && !selection_.takes(e.b) && !selection_.takes(e.detector); });
    if (json_) return print(console_, json_of(c));
    const std::string left_out =
        c.left_out == 0 ? "" : "  " + std::to_string(c.left_out) + " points with " + number(c.force_left_out) + " N are not sent";
    console_.out(console_.styled(Style::Bold, when(c.step, c.time)) + "  " + std::to_string(c.entries.size()) + " pairs" + left_out + "\n");
    if (!c.entries.empty()) contact_table(c).print(console_);
}

bool WatchPrinter::collision(const plab_v2_Collisions& sample, std::uint32_t entry)
{
    const plab_v2_CollisionInfo& c = sample.entries._buffer[entry];
    if (!selection_.takes(c.a) && !selection_.takes(c.b) && !selection_.takes(c.detector)) return false;
    const Vec3 position = vector(c.position), impulse = vector(c.impulse);
    if (json_)
    {
        print(console_, json_of(sample, entry));
        return true;
    }
    std::string text = when(sample.step, c.time) + "  " + console_.styled(Style::Cyan, padded(printable(c.kind), 6)) + "  " +
                       printable(c.a) + " - " + printable(c.b);
    // A contact that ended has no position and no normal any more.
    if (length(vector(c.normal)) > 0) text += "  at " + number(position.x) + " " + number(position.y) + " " + number(position.z);
    if (const double j = length(impulse); j > 0) text += "  impulse " + number(j) + " N s";
    if (c.depth > 0) text += "  depth " + number(c.depth) + " m";
    console_.out(text + "  (" + printable(c.detector) + ")\n");
    return true;
}

bool WatchPrinter::event(const plab_v2_Events& sample, std::uint32_t entry)
{
    const plab_v2_EventInfo& e = sample.entries._buffer[entry];
    if (!selection_.takes(e.component_id) && !selection_.takes(e.a) && !selection_.takes(e.b)) return false;
    if (json_)
    {
        print(console_, json_of(sample, entry));
        return true;
    }
    std::string text = when(sample.step, e.time) + "  " + padded(printable(e.severity), 7) + "  " + printable(e.kind);
    for (const char* id : {e.component_id, e.a, e.b})
        if (*id != 0) text += "  " + printable(id);
    if (*e.message != 0) text += ": " + printable(e.message);
    for (std::uint32_t i = 0; i < e.values._length; ++i) text += " " + number(e.values._buffer[i]);
    console_.out(console_.styled(style_of(e.severity), text) + "\n");
    return true;
}

void WatchPrinter::gap(const char* what, std::uint64_t missed, std::uint64_t before)
{
    console_.say("plabctl: missed " + std::to_string(missed) + " " + what + " before number " + std::to_string(before));
}

}  // namespace plab::cli
