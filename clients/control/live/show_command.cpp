#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "control/console/table.h"
#include "control/live/commands.h"
#include "control/live/frames.h"
#include "control/live/metrics_text.h"
#include "link/names.h"

namespace plab::cli
{
namespace
{

constexpr link::Seconds kWaitForFrame(0.3);

std::string text_of(const Vec3& v) { return number(v.x) + " " + number(v.y) + " " + number(v.z); }
std::string text_of(const Quat& q) { return number(q.w) + " " + number(q.x) + " " + number(q.y) + " " + number(q.z) + " (w x y z)"; }
std::string yes_no(bool value) { return value ? "yes" : "no"; }

std::string join(const std::vector<std::string>& words)
{
    std::string out;
    for (const std::string& w : words) out += (out.empty() ? "" : " ") + w;
    return out;
}

void title(const Console& console, const std::string& id, const std::string& kind, const std::string& type)
{
    console.out(console.styled(Style::Bold, printable(id)) + "  " + kind + (type.empty() ? "" : ", " + printable(type)) + "\n");
}

const link::FieldInfo* find_field(const link::Type* type, const std::string& name)
{
    if (type == nullptr) return nullptr;
    const auto at = std::find_if(type->fields.begin(), type->fields.end(), [&](const auto& f) { return f.name == name; });
    return at == type->fields.end() ? nullptr : &*at;
}

bool is_block(const std::string& text) { return text.find('\n') != std::string::npos; }

/// Values with their description from the type; texts of several lines (scripts) follow below the table.
void print_parameters(const Console& console, const std::vector<link::Parameter>& parameters, const link::Type* type)
{
    Table table({{"field"},
                 {"value", Align::Left, Shrink::Wrap},
                 {"unit"},
                 {"kind"},
                 {"rule", Align::Left, Shrink::Wrap},
                 {"meaning", Align::Left, Shrink::Wrap}});
    for (const link::Parameter& p : parameters)
    {
        const link::FieldInfo* const f = find_field(type, p.name);
        table.add({p.name, is_block(p.text) ? "(below)" : p.text, p.unit, p.kind, f != nullptr ? f->rule : "", f != nullptr ? f->doc : ""});
    }
    if (!table.empty()) console.out("\n");
    table.print(console);
    for (const link::Parameter& p : parameters)
    {
        if (!is_block(p.text)) continue;
        console.out("\n" + console.styled(Style::Bold, printable(p.name)) + "\n");
        std::string line;
        for (std::size_t begin = p.text.find_first_not_of('\n'); begin < p.text.size(); begin += line.size() + 1)
        {
            line = p.text.substr(begin, p.text.find('\n', begin) - begin);
            console.out("  " + printable(line) + "\n");
        }
    }
}

void print_object(Context& c, const link::Object& o, const Motion* motion, const link::Type* type)
{
    title(c.console, o.component_id, link::is_shaft(o) ? "shaft" : "body", o.type_name);
    Lines lines;
    lines.add("name", o.name == o.component_id ? "" : o.name);
    lines.add("motion", o.motion);
    lines.add(link::is_shaft(o) ? "inertia" : "mass", number(o.mass) + (link::is_shaft(o) ? " kg m2" : " kg"));
    const bool is_body_in_motion = motion != nullptr && !motion->is_shaft;
    lines.add("position", text_of(is_body_in_motion ? motion->position : o.position) + " m");
    lines.add("orientation", text_of(is_body_in_motion ? motion->orientation : o.orientation));
    if (is_body_in_motion) lines.add("velocity", text_of(motion->linear_velocity) + " m/s");
    if (is_body_in_motion) lines.add("angular velocity", text_of(motion->angular_velocity) + " rad/s");
    if (motion != nullptr && motion->is_shaft) lines.add("angle", number(motion->angle) + " rad");
    if (motion != nullptr && motion->is_shaft) lines.add("speed", number(motion->speed) + " rad/s");
    lines.add("shapes", join(o.shapes));
    lines.add("quarantined", o.quarantined ? "yes" : "");
    lines.print(c.console);
    print_parameters(c.console, o.parameters, type);
}

void print_shape(Context& c, const link::Shape& s)
{
    title(c.console, s.component_id, "shape", s.type_name);
    Lines lines;
    lines.add("form", s.form);
    lines.add("position in its body", text_of(s.position) + " m");
    lines.add("orientation in its body", text_of(s.orientation));
    if (s.form == "sphere") lines.add("radius", number(s.size.x) + " m");
    if (s.form == "box") lines.add("half extents", text_of(s.size) + " m");
    if (s.form == "mesh")
        lines.add("mesh",
                  std::to_string(s.vertices.size()) + " vertices, " + std::to_string(link::triangles_of(s).size() / 3) + " triangles");
    lines.print(c.console);
}

void print_interaction(Context& c, const link::Interaction& i, const link::InteractionMetrics* m, const link::Type* type)
{
    title(c.console, i.component_id, "interaction", i.type_name);
    Lines lines;
    lines.add("name", i.name == i.component_id ? "" : i.name);
    lines.add("family", i.family);
    for (const link::Participants& p : i.roles) lines.add(p.role, join(p.members));
    lines.add("since step", std::to_string(i.since));
    lines.add("quarantined", i.quarantined ? "yes" : "");
    if (m != nullptr)
    {
        lines.add("asked for", m->requested);
        lines.add("resolved", m->resolved == m->requested ? "" : m->resolved);
        lines.add("cost", cost_in_words(*m));
        const std::string meaning = error_meaning(*m);
        lines.add("error", error_text(*m) + " " + error_unit(*m) + (meaning.empty() ? "" : "  (" + meaning + ")"));
        lines.add("work", number(m->work) + " J");
        for (const link::Parameter& p : m->outputs)
            if (p.kind != "account") lines.add(p.name, p.text + (p.unit.empty() ? "" : " " + p.unit));
    }
    lines.print(c.console);
    print_parameters(c.console, i.parameters, type);
}

std::string arity(const link::RoleInfo& r)
{
    if (r.most == link::kAnyNumber) return std::to_string(r.least) + " or more";
    return r.least == r.most ? std::to_string(r.least) : std::to_string(r.least) + " to " + std::to_string(r.most);
}

void print_type(Context& c, const link::Type& t)
{
    title(c.console, t.type_name, "type", "");
    Lines lines;
    lines.add("does", t.doc);
    lines.add("family", t.family);
    lines.add("plugin", t.plugin);
    lines.add("loaded", yes_no(t.is_loaded));
    lines.add("order", t.order > 0 ? std::to_string(t.order) : "");
    lines.add("accuracy", t.accuracy);
    lines.add("good for", t.strengths);
    lines.add("cost", t.cost);
    lines.add("limits", t.limits);
    lines.add("source", t.source);
    lines.print(c.console);
    Table roles({{"role"}, {"accepts"}, {"number", Align::Right}, {"meaning", Align::Left, Shrink::Wrap}});
    for (const link::RoleInfo& r : t.roles) roles.add({r.name, r.accepts, arity(r), r.doc});
    if (!roles.empty()) c.console.out("\n");
    roles.print(c.console);
    Table fields({{"field"},
                  {"kind"},
                  {"value"},
                  {"unit"},
                  {"default", Align::Left, Shrink::Wrap},
                  {"rule", Align::Left, Shrink::Wrap},
                  {"meaning", Align::Left, Shrink::Wrap}});
    for (const link::FieldInfo& f : t.fields)
        fields.add({f.name, f.kind, f.value_type, f.unit, f.required ? "(required)" : f.fallback, f.rule, f.doc});
    if (!fields.empty()) c.console.out("\n");
    fields.print(c.console);
}

const link::Type* find_type(const link::CatalogueContents& now, const std::string& name)
{
    const auto at = now.types.find(name);
    return at == now.types.end() ? nullptr : &at->second;
}

Json with_type(const char* kind, Json json, const link::Type* type)
{
    Json out{{"kind", kind}};
    json.erase("kind");
    out.update(json);
    out["type_info"] = type != nullptr ? json_of(*type) : Json();
    return out;
}

Exit show_object(Context& c, const link::CatalogueContents& now, const link::Object& o)
{
    std::optional<Frame> frame;
    if (!now.server->paused && o.motion != "static") frame = next_frame(c.session(), kWaitForFrame);
    const Motion* motion = nullptr;
    if (frame && frame->run == o.run)
        if (const auto at = frame->motions.find(o.handle); at != frame->motions.end()) motion = &at->second;
    if (!c.settings.json)
        print_object(c, o, motion, find_type(now, o.type_name));
    else
    {
        Json json = with_type(link::is_shaft(o) ? "shaft" : "body", json_of(o), find_type(now, o.type_name));
        json["state"] = motion != nullptr ? json_of(*motion) : Json();
        print(c.console, json);
    }
    return Exit::Done;
}

Exit show_interaction(Context& c, const link::CatalogueContents& now, const link::Interaction& i)
{
    const link::InteractionMetrics* const m = link::find_metrics(now.metrics, i.component_id);
    if (!c.settings.json)
        print_interaction(c, i, m, find_type(now, i.type_name));
    else
    {
        Json json = with_type("interaction", json_of(i), find_type(now, i.type_name));
        json["metrics"] = m != nullptr ? json_of(*m) : Json();
        print(c.console, json);
    }
    return Exit::Done;
}

Exit unknown(const Context& c, const link::CatalogueContents& now, const std::string& id)
{
    std::set<std::string> known;
    for (const auto& [name, thing] : now.objects) known.insert(name);
    for (const auto& [name, thing] : now.shapes) known.insert(name);
    for (const auto& [name, thing] : now.interactions) known.insert(name);
    for (const auto& [name, thing] : now.types) known.insert(name);
    return c.fail(Exit::Failed,
                  "no object, shape, interaction or type '" + id + "'" + link::did_you_mean(id, {known.begin(), known.end()}));
}

Exit run_show(Context& c, const std::string& id)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto catalogue = link::Catalogue::open(c.session());
    if (!catalogue) return c.fail(Exit::Failed, catalogue.errors());
    if (auto fetched = catalogue->fetch(c.timeout(), c.stop()); !fetched) return c.fail(Exit::NoServer, fetched.errors());
    const link::CatalogueContents& now = catalogue->now();
    if (const auto o = now.objects.find(id); o != now.objects.end()) return show_object(c, now, o->second);
    if (const auto i = now.interactions.find(id); i != now.interactions.end()) return show_interaction(c, now, i->second);
    if (const auto s = now.shapes.find(id); s != now.shapes.end())
    {
        if (c.settings.json)
            print(c.console, with_type("shape", json_of(s->second), find_type(now, s->second.type_name)));
        else
            print_shape(c, s->second);
        return Exit::Done;
    }
    const link::Type* const type = find_type(now, id);
    if (type == nullptr) return unknown(c, now, id);
    if (c.settings.json)
    {
        Json json{{"kind", "type"}};
        json.update(json_of(*type));
        print(c.console, json);
    }
    else
        print_type(c, *type);
    return Exit::Done;
}

}  // namespace

void add_show_command(const Command& app, Context& context)
{
    auto id = std::make_shared<std::string>();
    const Command command = add_command(app, context,
                                        {"show", "print everything known about an object, shape, interaction or type",
                                         "  plabctl show red\n  plabctl show contact.response\n  plabctl show Response/Impulse\n"},
                                        [id](Context& c) { return run_show(c, *id); });
    command.add_option("id", *id, "component or type").required().type_name("ID");
}

}  // namespace plab::cli
