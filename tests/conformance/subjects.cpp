#include "subjects.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace plab::test
{
namespace
{

namespace fs = std::filesystem;

constexpr std::string_view kPlaceholder = "$TYPE";

struct Catalogue
{
    std::vector<Subject> subjects;
    std::vector<std::string> missing;
};

std::string dotted(std::string type)
{
    std::replace(type.begin(), type.end(), '/', '.');
    return type;
}

/// The scene for the longest beginning of the type's name that has one; empty if none has.
fs::path scene_for(const std::string& type)
{
    for (std::string name = dotted(type); !name.empty();)
    {
        for (const std::string& folder : target().scene_folders)
            if (const fs::path path = fs::path(folder) / (name + ".xml"); fs::exists(path)) return path;
        const std::size_t dot = name.rfind('.');
        name = dot == std::string::npos ? std::string() : name.substr(0, dot);
    }
    return {};
}

std::string how_to_add(const std::string& type)
{
    return "no scene gives " + type + " its participants: write " +
           (target().scene_folders.empty() ? "" : target().scene_folders[0] + "/") + dotted(type) +
           ".xml, a blueprint with <component id=\"subject\" type=\"$TYPE\" ...> and whoever it needs";
}

std::string text_of(const fs::path& path, const std::string& type)
{
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    std::string out = text.str();
    for (std::size_t at = 0; (at = out.find(kPlaceholder, at)) != std::string::npos; at += type.size())
        out.replace(at, kPlaceholder.size(), type);
    return out;
}

bool has_subject(const model::Blueprint& blueprint, const std::string& type)
{
    return std::any_of(blueprint.components.begin(), blueprint.components.end(),
                       [&](const model::ComponentNode& c) { return c.id == kSubject && c.type == type; });
}

void add_subject(Catalogue& catalogue, const std::string& type)
{
    const fs::path path = scene_for(type);
    if (path.empty()) return catalogue.missing.push_back(how_to_add(type));
    auto blueprint = blueprint::read_blueprint(text_of(path, type), path.string());
    if (!blueprint) return catalogue.missing.push_back(type + ": " + first_error(blueprint.errors()));
    if (!has_subject(*blueprint, type))
        return catalogue.missing.push_back(path.string() + " has no top-level component 'subject' of type $TYPE");
    catalogue.subjects.push_back({type, blueprint.take()});
}

const Catalogue& catalogue()
{
    static const Catalogue instance = []
    {
        Catalogue out;
        for (const std::string& type : tested_types()) add_subject(out, type);
        return out;
    }();
    return instance;
}

std::vector<std::string> files_of_plugins()
{
    if (!target().plugin.empty()) return {target().plugin};
    std::vector<std::string> out;
    for (const std::string& folder : plugin_folders())
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.path().extension() == ".manifest") out.push_back(fs::path(entry.path()).replace_extension(".so").string());
    std::sort(out.begin(), out.end());
    return out;
}

std::vector<std::string> types_of_plugins()
{
    if (tests_all_plugins()) return library().names();
    const auto plugin = library().load_plugin(target().plugin);
    std::vector<std::string> out = plugin ? plugin->types : std::vector<std::string>();
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace

Target& target()
{
    static Target instance{{}, {PLAB_CONFORMANCE_SCENES}};
    return instance;
}

bool tests_all_plugins() { return target().plugin.empty(); }

const std::vector<std::string>& tested_plugins()
{
    static const std::vector<std::string> out = files_of_plugins();
    return out;
}

const std::vector<std::string>& tested_types()
{
    static const std::vector<std::string> out = types_of_plugins();
    return out;
}

bool is_tested(const std::string& type) { return std::binary_search(tested_types().begin(), tested_types().end(), type); }

bool Subject::repeatable() const
{
    return std::none_of(blueprint.settings.begin(), blueprint.settings.end(),
                        [](const model::TextNode& s) { return s.name == "title" && s.text == "alone"; });
}

const std::vector<Subject>& subjects() { return catalogue().subjects; }

const std::vector<std::string>& subjects_missing() { return catalogue().missing; }

model::ComponentNode& subject_node(model::Blueprint& blueprint)
{
    const auto found = std::find_if(blueprint.components.begin(), blueprint.components.end(),
                                    [](const model::ComponentNode& c) { return c.id == kSubject; });
    REQUIRE(found != blueprint.components.end());
    return *found;
}

bool settable(const Field& field) { return field.kind == FieldKind::Param || field.kind == FieldKind::State; }

model::Blueprint with_field(const model::Blueprint& scene, const std::string& name, const std::string& text)
{
    model::Blueprint out = scene;
    model::ComponentNode& node = subject_node(out);
    const auto erase_named = [&](auto& nodes) { std::erase_if(nodes, [&](const auto& n) { return n.name == name; }); };
    erase_named(node.attributes), erase_named(node.parameters), erase_named(node.values);
    model::TextNode given;
    given.name = name, given.text = text;
    node.parameters.push_back(given);
    return out;
}

const Schema& schema_of(const Subject& subject)
{
    const auto type = library().require(subject.type);
    REQUIRE(type.ok());
    return (*type)->schema;
}

int count_of_reals(FieldType type)
{
    switch (type)
    {
        case FieldType::Real:
        case FieldType::RealList:
            return 1;
        case FieldType::Vector:
        case FieldType::Matrix:
            return 3;
        case FieldType::Rotation:
            return 4;
        default:
            return 0;
    }
}

model::Blueprint repeated(const Subject& subject)
{
    model::Blueprint out = subject.blueprint;
    model::RepeatNode repeat;
    for (const auto& [name, text] : {std::pair{"count", "4"}, {"step", "100 0 0"}})
    {
        model::TextNode& attribute = repeat.attributes.emplace_back();
        attribute.name = name, attribute.text = text;
    }
    repeat.components.swap(out.components);
    out.repeats.push_back(std::move(repeat));
    return out;
}

model::SceneSpec compiled(const model::Blueprint& blueprint, model::TypeSource& types)
{
    auto scene = model::compile(blueprint, types);
    REQUIRE_MESSAGE(scene.ok(), reasons(scene));
    return scene.take();
}

std::unique_ptr<simulation::Simulation> started(const model::SceneSpec& scene, int threads, model::TypeSource& types)
{
    auto out = std::make_unique<simulation::Simulation>(types, threads);
    const auto loaded = out->load(scene);
    REQUIRE_MESSAGE(loaded.ok(), reasons(loaded));
    return out;
}

std::vector<std::uint64_t> hashes(simulation::Simulation& simulation, int steps)
{
    std::vector<std::uint64_t> out;
    for (int i = 0; i < steps; ++i)
    {
        simulation.step();
        out.push_back(simulation.state_hash());
    }
    return out;
}

int first_difference(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b)
{
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i] != b[i]) return static_cast<int>(i);
    return -1;
}

}  // namespace plab::test
