#include "blueprint/writer.h"

#include <algorithm>
#include <map>
#include <set>

#include "blueprint/entry_text.h"
#include "blueprint/xgl.h"
#include "blueprint/xml.h"
#include "model/numbers.h"
#include "model/values.h"

namespace plab::blueprint
{
namespace
{

using model::ComponentSpec;
using model::FieldSpec;
using model::RoleSpec;

/// One line of a stage list.
struct StageEntry
{
    Phase phase;
    const ComponentSpec* subject;
    std::string command;
};

/// The content of a simulation command: every component of a subtree that has commands, and which of them take part.
struct Simulation
{
    std::vector<StageEntry> entries;
    bool any_type = false;  ///< there is a typed component, so the command must be written even if it is empty
};

std::string attribute(std::string_view name, std::string_view value)
{
    return " " + std::string(name) + "=\"" + escape_attribute(value) + "\"";
}

/// Ids that are possible in a list separated by blanks.
bool fits_in_list(const std::string& id) { return id != "*" && id.find_first_of(" \t\r\n") == id.npos; }

template <class T>
const T* find_value(const ComponentSpec& c, std::string_view name)
{
    for (const FieldSpec& f : c.fields)
        if (f.name == name) return std::get_if<T>(&f.value);
    return nullptr;
}

/// Whether the text is XML.
bool is_well_formed(std::string_view text)
{
    class Nothing final : public XmlSink
    {
    public:
        bool begin(const XmlElement&) override { return true; }
        void child(XmlElement) override {}
        void end(XmlElement) override {}
    } nothing;
    Errors errors;
    return parse_xml(text, {}, nothing, errors) && errors.empty();
}

/// The <template> element of a text that the reader made of one (blueprint/template.h); empty if it is none.
std::string template_element(std::string_view text)
{
    constexpr std::string_view kOpen = "<plab version=\"1\">", kClose = "</plab>";
    if (!text.starts_with(kOpen) || !text.ends_with(kClose) || !is_well_formed(text)) return {};
    text.remove_prefix(kOpen.size()), text.remove_suffix(kClose.size());
    text.remove_prefix(std::min(text.size(), text.find_first_not_of('\n')));
    return "<template>" + std::string(text) + "</template>\n";
}

class LongForm
{
public:
    LongForm(const model::SceneSpec& scene, model::TypeSource& types) : scene_(scene), types_(types)
    {
        for (const ComponentSpec& c : scene.components) ids_.insert(c.id);
        for (const ComponentSpec& c : scene.components) children_[ids_.contains(c.parent) ? c.parent : std::string()].push_back(&c);
    }

    std::string run()
    {
        out_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<plab version=\"1\">\n";
        settings();
        for (const ComponentSpec* c : children_[{}]) component(*c, 1, true);
        return out_ + "</plab>\n";
    }

private:
    static std::string indent(std::size_t depth) { return std::string(2 * depth, ' '); }

    void settings()
    {
        const model::SceneSettings& s = scene_.settings;
        out_ += "  <scene" + attribute("dt", step_length(s.dt)) + attribute("seed", std::to_string(s.seed));
        if (ids_.contains(s.solver))
            out_ += attribute("solver", s.solver);
        else if (s.solver_type != model::SceneSettings{}.solver_type)
            out_ += attribute("solver", s.solver_type);
        if (!s.title.empty()) out_ += attribute("title", s.title);
        out_ += s.cameras.empty() ? "/>\n" : ">\n";
        for (const model::Camera& c : s.cameras)
            out_ += "    <camera" + attribute("id", c.name) + attribute("position", model::format_value(c.position)) +
                    attribute("look_at", model::format_value(c.look_at)) + attribute("up", model::format_value(c.up)) +
                    attribute("field_of_view", model::format_real(c.field_of_view)) + "/>\n";
        if (!s.cameras.empty()) out_ += "  </scene>\n";
    }

    static std::string step_length(const model::StepLength& dt)
    {
        if (dt.denominator <= 0) return model::format_real(dt.seconds);
        return std::to_string(dt.numerator) + "/" + std::to_string(dt.denominator);
    }

    void component(const ComponentSpec& c, std::size_t depth, bool top)
    {
        out_ += indent(depth) + "<component" + attribute("id", c.id);
        if (!c.name.empty()) out_ += attribute("name", c.name);
        if (!c.type.empty()) out_ += attribute("type", c.type);
        for (const RoleSpec& r : c.roles) role_attribute(r);
        out_ += ">\n";
        const std::size_t content = out_.size();

        if (!c.alias_of.empty()) reference(c.alias_of, depth + 1);
        for (const std::string& id : c.group) reference(id, depth + 1);
        for (const RoleSpec& r : c.roles) role_element(r, depth + 1);
        fields(c, depth + 1);
        if (const auto at = children_.find(c.id); at != children_.end())
            for (const ComponentSpec* child : at->second) component(*child, depth + 1, false);
        if (top) simulation(c, depth + 1);

        if (out_.size() > content)
            out_ += indent(depth) + "</component>\n";
        else
            out_.replace(content - 2, 2, "/>\n");
    }

    void reference(const std::string& id, std::size_t depth) { out_ += indent(depth) + "<compref>" + escape_text(id) + "</compref>\n"; }

    static bool means_all(const RoleSpec& r) { return r.everyone && r.patterns.empty(); }
    static const std::vector<std::string>& written_ids(const RoleSpec& r) { return r.everyone ? r.patterns : r.members; }

    static std::string joined(const RoleSpec& r)
    {
        if (means_all(r)) return "*";
        std::string ids;
        for (const std::string& id : written_ids(r)) ids += (ids.empty() ? "" : " ") + id;
        return ids;
    }

    /// Whether a list separated by blanks can name these members: no id may contain blanks, and none may read like the whole
    /// list.
    bool is_list(const RoleSpec& r) const
    {
        if (means_all(r)) return true;
        const std::vector<std::string>& ids = written_ids(r);
        return std::all_of(ids.begin(), ids.end(), fits_in_list) && (ids.size() < 2 || !ids_.contains(joined(r)));
    }

    void role_attribute(const RoleSpec& r)
    {
        if (is_list(r) && !joined(r).empty()) out_ += attribute(r.name, joined(r));
    }

    void role_element(const RoleSpec& r, std::size_t depth)
    {
        if (is_list(r)) return;
        out_ += indent(depth) + "<param" + attribute("name", r.name) + ">\n";
        for (const std::string& id : written_ids(r)) reference(id, depth + 1);
        out_ += indent(depth) + "</param>\n";
    }

    void fields(const ComponentSpec& c, std::size_t depth)
    {
        const Reals* vertices = find_value<Reals>(c, "vertices");
        const Integers* triangles = find_value<Integers>(c, "triangles");
        const bool mesh = vertices && triangles && is_xgl_mesh(*vertices, *triangles);
        for (const FieldSpec& f : c.fields)
            if (!mesh || (f.name != "vertices" && f.name != "triangles")) field(f, depth);
        if (mesh) out_ += write_xgl_mesh(*vertices, *triangles, 2 * depth);
    }

    void field(const FieldSpec& f, std::size_t depth)
    {
        if (type_of(f.value) == FieldType::None) return;
        const Entries* entries = std::get_if<Entries>(&f.value);
        if (const auto* text = std::get_if<std::string>(&f.value); text && f.name == "template")
            if (const std::string element = template_element(*text); !element.empty()) return void(out_ += indent(depth) + element);
        const std::string open = indent(depth) + "<param" + attribute("name", f.name) + ">";
        if (!entries)
        {
            out_ += open + escape_text(model::format_value(f.value)) + "</param>\n";
            return;
        }
        const bool is_state = f.name == "state" && !entries->empty();  // an empty record needs a <param>, so that it counts as given
        const std::string tag = is_state ? "state" : "entry";
        if (entries->empty()) return void(out_ += open + "</param>\n");
        if (!is_state) out_ += open + "\n";
        for (const Entry& e : *entries)
            out_ += indent(is_state ? depth : depth + 1) + "<" + tag + attribute("name", e.name) + ">" +
                    escape_text(format_entry(e.value)) + "</" + tag + ">\n";
        if (!is_state) out_ += indent(depth) + "</param>\n";
    }

    void collect(const ComponentSpec& c, Simulation& sim)
    {
        if (const auto type = c.type.empty() ? nullptr : find_type(c.type))
        {
            sim.any_type = true;
            for (const CommandInfo& command : type->info.commands)
                if (takes_part(c, command)) sim.entries.push_back({command.phase, &c, command.name});
        }
        if (const auto at = children_.find(c.id); at != children_.end())
            for (const ComponentSpec* child : at->second) collect(*child, sim);
    }

    const model::ComponentType* find_type(const std::string& name)
    {
        const auto type = types_.require(name);
        return type ? *type : nullptr;
    }

    /// Measure always runs. Prepare and Connect also run as parts of building a component, and Linearize with the force that it describes:
    /// they are listed only if the author listed them.
    static bool takes_part(const ComponentSpec& c, const CommandInfo& command)
    {
        const bool listed = std::find(c.commands.begin(), c.commands.end(), command.name) != c.commands.end();
        const bool runs_with_another =
            command.phase == Phase::Prepare || command.phase == Phase::Connect || command.phase == Phase::Linearize;
        if (runs_with_another) return c.explicit_commands && listed;
        return !c.explicit_commands || listed || command.phase == Phase::Measure;
    }

    /// The name that the paper uses, unless it is longer than a name may be.
    static std::string simulation_name(const ComponentSpec& c)
    {
        const std::string word = "Simulation";
        return c.id.size() + 1 + word.size() > kLongestName ? word : c.id + "/" + word;
    }

    void simulation(const ComponentSpec& c, std::size_t depth)
    {
        Simulation sim;
        collect(c, sim);
        if (!sim.any_type) return;
        // Within a stage, commands are in the order of the step; a list that contradicts this order would be refused.
        std::stable_sort(sim.entries.begin(), sim.entries.end(),
                         [](const StageEntry& a, const StageEntry& b) { return a.phase < b.phase; });
        out_ += indent(depth) + "<command" + attribute("name", simulation_name(c)) + ">\n";
        bool empty = true;
        for (int s = 0; s <= static_cast<int>(Stage::Deinit); ++s) empty = !stage(static_cast<Stage>(s), sim, depth + 1) && empty;
        if (empty) out_ += indent(depth + 1) + "<command name=\"Stage/Init\"/>\n";
        out_ += indent(depth) + "</command>\n";
    }

    bool stage(Stage stage, const Simulation& sim, std::size_t depth)
    {
        std::string lines;
        for (const StageEntry& e : sim.entries)
            if (stage_of(e.phase) == stage)
                lines += indent(depth + 1) + "<command" + attribute("subject", e.subject->id) + attribute("type", e.command) + "/>\n";
        if (lines.empty()) return false;
        out_ += indent(depth) + "<command" + attribute("name", "Stage/" + std::string(name_of(stage))) + ">\n" + lines + indent(depth) +
                "</command>\n";
        return true;
    }

    const model::SceneSpec& scene_;
    model::TypeSource& types_;
    std::set<std::string> ids_;
    std::map<std::string, std::vector<const ComponentSpec*>> children_;  ///< by parent; "" is the top level
    std::string out_;
};

std::string escaped(std::string_view text, bool attribute)
{
    std::string out;
    for (const char c : text) switch (c)
        {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '\r':
                out += "&#13;";
                break;
            case '"':
                out += attribute ? "&quot;" : "\"";
                break;
            case '\n':
                out += attribute ? "&#10;" : "\n";
                break;
            case '\t':
                out += attribute ? "&#9;" : "\t";
                break;
            default:
                if (static_cast<unsigned char>(c) < 0x20)
                    out += "\xEF\xBF\xBD";
                else
                    out += c;
        }
    return out;
}

}  // namespace

std::string escape_text(std::string_view text) { return escaped(text, false); }

std::string escape_attribute(std::string_view text) { return escaped(text, true); }

std::string write_long_form(const model::SceneSpec& scene, model::TypeSource& types) { return LongForm(scene, types).run(); }

}  // namespace plab::blueprint
