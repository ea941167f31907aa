#include <algorithm>
#include <cctype>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "control/console/table.h"
#include "control/live/commands.h"
#include "control/live/frames.h"
#include "control/live/metrics_text.h"
#include "link/names.h"

namespace plab::cli
{
namespace
{

// A server with 4 frames per second still shows current positions.
constexpr link::Seconds kForFrame(0.3);

Result<link::Catalogue> fetch(Context& c, link::Parts parts)
{
    auto catalogue = link::Catalogue::open(c.session(), parts);
    if (!catalogue) return catalogue;
    if (auto fetched = catalogue->fetch(c.timeout(), c.stop()); !fetched) return fetched.errors();
    return catalogue;
}

std::string three_decimals(double value)
{
    char buffer[64];
    return {buffer, static_cast<std::size_t>(std::snprintf(buffer, sizeof buffer, std::abs(value) < 1e6 ? "%.3f" : "%.3g", value))};
}

// ---- servers --------------------------------------------------------------------------------------------------------

/// Conditions that a user should know: an incomplete recording, samples that rings dropped.
std::string note_of(const link::ServerInfo& s)
{
    std::string out = s.recording.trouble.empty() ? "" : "recording is stalled: " + s.recording.trouble;
    const auto add = [&](const std::string& text) { out += (out.empty() ? "" : "; ") + text; };
    if (s.recording.dropped > 0) add(std::to_string(s.recording.dropped) + " messages not recorded");
    for (const auto& [topic, samples] : s.dropped)
        if (samples > 0) add(std::to_string(samples) + " of " + topic + " dropped");
    return out;
}

void print_servers(const Console& console, const std::vector<link::ServerInfo>& servers)
{
    const auto now = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
    Table table({{"server", Align::Left, Shrink::Middle},
                 {"state"},
                 {"step", Align::Right, Shrink::Never, 2},
                 {"time", Align::Right},
                 {"pace", Align::Right, Shrink::Never, 4},
                 {"run", Align::Right, Shrink::Never, 5},
                 {"scene", Align::Left, Shrink::Middle, 3},
                 {"note", Align::Left, Shrink::End},
                 {"up", Align::Right, Shrink::Never, 6},
                 {"process", Align::Right, Shrink::Never, 7},
                 {"host", Align::Left, Shrink::End},
                 {"version", Align::Left, Shrink::Never, 8}});
    for (const link::ServerInfo& s : servers)
        table.add({s.name, state_text(s), std::to_string(s.step), three_decimals(s.time) + " s", number(s.rate_reached) + "x",
                   std::to_string(s.run), s.scene_file, note_of(s), age_text(static_cast<double>(now - s.started_ns) * 1e-9),
                   std::to_string(s.process), s.host, s.version},
                  !s.recording.trouble.empty() || s.recording.dropped > 0 ? Style::Red
                  : s.paused                                              ? Style::Dim
                  : s.overload.empty()                                    ? Style::Plain
                                                                          : Style::Yellow);
    table.print(console);
}

Exit run_servers(Context& c)
{
    // All servers, whichever one --server names; each announces itself at once to a new participant.
    c.settings.link.server.clear();
    if (const Exit e = c.join(); e != Exit::Done) return e;
    const std::vector<link::ServerInfo> servers = c.session().servers(c.timeout(0.5));
    if (c.settings.json)
    {
        Json list = Json::array();
        for (const link::ServerInfo& s : servers) list.push_back(json_of(s));
        print(c.console, {{"domain", c.settings.link.domain.id}, {"servers", list}});
    }
    else
        print_servers(c.console, servers);
    if (servers.empty()) return c.fail(Exit::NoServer, "no server was found in domain " + std::to_string(c.settings.link.domain.id));
    return Exit::Done;
}

// ---- objects --------------------------------------------------------------------------------------------------------

std::vector<std::string> object_row(const link::Object& o, const Motion* m)
{
    const Vec3 p = m != nullptr && !m->is_shaft ? m->position : o.position;
    std::string speed, angle;
    if (m != nullptr) speed = m->is_shaft ? number(m->speed) + " rad/s" : number(length(m->linear_velocity)) + " m/s";
    if (m != nullptr && m->is_shaft) angle = three_decimals(m->angle) + " rad";
    return {o.component_id,
            o.type_name,
            o.motion,
            number(o.mass) + (link::is_shaft(o) ? " kg m2" : " kg"),
            three_decimals(p.x),
            three_decimals(p.y),
            three_decimals(p.z),
            angle,
            speed,
            o.quarantined ? "quarantined" : "",
            o.name == o.component_id ? "" : o.name};
}

Exit run_objects(Context& c)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto catalogue = fetch(c, static_cast<link::Parts>(link::Part::Objects));
    if (!catalogue) return c.fail(Exit::NoServer, catalogue.errors());
    const auto& objects = catalogue->now().objects;
    std::optional<Frame> frame;
    if (!objects.empty() && !catalogue->now().server->paused) frame = next_frame(c.session(), kForFrame);
    Json list = Json::array();
    Table table({{"object", Align::Left, Shrink::Middle},
                 {"type", Align::Left, Shrink::Middle, 4},
                 {"motion", Align::Left, Shrink::Never, 6},
                 {"mass", Align::Right, Shrink::Never, 5},
                 {"x", Align::Right},
                 {"y", Align::Right},
                 {"z", Align::Right},
                 {"angle", Align::Right, Shrink::Never, 3},
                 {"speed", Align::Right, Shrink::Never, 2},
                 {"state", Align::Left, Shrink::Never, 1},
                 {"name", Align::Left, Shrink::End}});
    for (const auto& [id, o] : objects)
    {
        const Motion* motion = nullptr;
        if (frame && frame->run == o.run)
            if (const auto at = frame->motions.find(o.handle); at != frame->motions.end()) motion = &at->second;
        table.add(object_row(o, motion), o.quarantined ? Style::Red : Style::Plain);
        list.push_back(json_of(o));
        list.back()["state"] = motion != nullptr ? json_of(*motion) : Json();
    }
    if (c.settings.json)
        print(c.console, {{"server", c.session().server()}, {"step", frame ? Json(frame->step) : Json()}, {"objects", list}});
    else if (table.empty())
        c.console.say("the scene has no objects");
    else
        table.print(c.console);
    return Exit::Done;
}

// ---- interactions ---------------------------------------------------------------------------------------------------

std::string members_text(const link::Interaction& i)
{
    std::string out;
    for (const link::Participants& p : i.roles)
    {
        if (p.members.empty()) continue;
        out += (out.empty() ? "" : "; ") + p.role;
        for (const std::string& member : p.members) out += " " + member;
    }
    return out;
}

std::string note_of(const link::Interaction& i, const link::InteractionMetrics* m)
{
    if (i.quarantined) return "quarantined";
    return m == nullptr ? "" : note_text(i.type_name, *m);
}

Exit run_interactions(Context& c)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto catalogue = fetch(c, link::Part::Interactions | link::Part::Metrics);
    if (!catalogue) return c.fail(Exit::NoServer, catalogue.errors());
    const link::CatalogueContents& now = catalogue->now();
    Json list = Json::array();
    Table table({{"interaction", Align::Left, Shrink::Middle},
                 {"algorithm", Align::Left, Shrink::Middle},
                 {"cost/step", Align::Right},
                 {"error", Align::Right, Shrink::Never, 1},
                 {"unit", Align::Left, Shrink::Never, 1},
                 {"work", Align::Right, Shrink::Never, 2},
                 {"since", Align::Right, Shrink::Never, 3},
                 {"note", Align::Left, Shrink::End},
                 {"participants", Align::Left, Shrink::End}});
    for (const auto& [id, i] : now.interactions)
    {
        const link::InteractionMetrics* const m = link::find_metrics(now.metrics, id);
        const std::string note = note_of(i, m);
        table.add({id, i.type_name, m ? cost_text(*m) : "", m ? error_text(*m) : "", m ? error_unit(*m) : "",
                   m ? number(m->work) + " J" : "", std::to_string(i.since), note, members_text(i)},
                  note == "quarantined" ? Style::Red
                  : note.empty()        ? Style::Plain
                                        : Style::Yellow);
        list.push_back(json_of(i));
        list.back()["metrics"] = m != nullptr ? json_of(*m) : Json();
    }
    if (c.settings.json)
        print(c.console,
              {{"server", c.session().server()}, {"step", now.metrics ? Json(now.metrics->step) : Json()}, {"interactions", list}});
    else if (table.empty())
        c.console.say("the scene has no interactions");
    else
        table.print(c.console);
    return Exit::Done;
}

// ---- types ----------------------------------------------------------------------------------------------------------

struct TypesOptions
{
    std::string pattern, family, replaces;
};

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char ch) { return static_cast<char>(std::tolower(ch)); });
    return text;
}

/// The family of the component's type; an error names similar ids.
Result<std::string> family_of(const link::CatalogueContents& now, const std::string& id)
{
    std::string type;
    if (const auto at = now.interactions.find(id); at != now.interactions.end()) type = at->second.type_name;
    if (const auto at = now.objects.find(id); at != now.objects.end()) type = at->second.type_name;
    if (const auto at = now.shapes.find(id); at != now.shapes.end()) type = at->second.type_name;
    if (const auto at = now.types.find(type); at != now.types.end()) return at->second.family;
    if (!type.empty()) return reason("the server does not list " + type + ", the type of '" + id + "'");
    std::vector<std::string> known;
    for (const auto& [other, i] : now.interactions) known.push_back(other);
    for (const auto& [other, o] : now.objects) known.push_back(other);
    for (const auto& [other, s] : now.shapes) known.push_back(other);
    return reason("no component '" + id + "'" + link::did_you_mean(id, known));
}

void print_types(Context& c, const std::vector<const link::Type*>& types)
{
    Json list = Json::array();
    Table table({{"type", Align::Left, Shrink::Middle},
                 {"family", Align::Left, Shrink::Middle, 1},
                 {"loaded", Align::Left, Shrink::Never, 3},
                 {"order", Align::Right, Shrink::Never, 2},
                 {"does", Align::Left, Shrink::End},
                 {"cost", Align::Left, Shrink::End}});
    for (const link::Type* t : types)
    {
        table.add({t->type_name, t->family, t->is_loaded ? "yes" : "no", t->order > 0 ? std::to_string(t->order) : "", t->doc, t->cost});
        list.push_back(json_of(*t));
    }
    if (c.settings.json)
        print(c.console, {{"server", c.session().server()}, {"types", list}});
    else if (table.empty())
        c.console.say("no type matches");
    else
        table.print(c.console);
}

Exit run_types(Context& c, const TypesOptions& o)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    link::Parts parts = static_cast<link::Parts>(link::Part::Types);
    if (!o.replaces.empty()) parts = parts | link::Part::Objects | link::Part::Shapes | link::Part::Interactions;
    auto catalogue = fetch(c, parts);
    if (!catalogue) return c.fail(Exit::NoServer, catalogue.errors());
    std::string family = o.family;
    if (!o.replaces.empty())
    {
        auto found = family_of(catalogue->now(), o.replaces);
        if (!found) return c.fail(Exit::Failed, found.errors());
        family = found.take();
    }
    std::vector<const link::Type*> shown;
    for (const auto& [name, t] : catalogue->now().types)
        if ((family.empty() || t.family == family) && lower(name + " " + t.family).find(lower(o.pattern)) != std::string::npos)
            shown.push_back(&t);
    print_types(c, shown);
    return Exit::Done;
}

}  // namespace

void add_list_commands(const Command& app, Context& context)
{
    add_command(app, context, {"servers", "list the servers in the domain", "  plabctl servers\n  plabctl servers --domain 7 --json\n"},
                run_servers);
    add_command(
        app, context,
        {"objects", "list bodies and shafts, with their motion", "  plabctl objects\n  plabctl objects --json | jq '.objects[].id'\n"},
        run_objects);
    add_command(app, context,
                {"interactions", "list all other components: algorithm, cost, error, work",
                 "  plabctl interactions\n  plabctl interactions --server lab --json\n"},
                run_interactions);
    auto o = std::make_shared<TypesOptions>();
    const Command types = add_command(app, context,
                                      {"types", "list the types that can be added or swapped in",
                                       "  plabctl types\n  plabctl types solver\n  plabctl types --for contact.response\n"},
                                      [o](Context& c) { return run_types(c, *o); });
    types.add_option("pattern", o->pattern, "part of a type's or family's name").type_name("TEXT");
    const Option family = types.add_option("--family", o->family, "of this family only").type_name("FAMILY");
    types.add_option("--for", o->replaces, "types that can replace this component").type_name("ID").excludes(family);
}

}  // namespace plab::cli
