#include "completion/scene_values.h"

#include <unistd.h>

#include <optional>

#include "blueprint/reader.h"
#include "model/compile.h"
#include "plugins/library.h"
#include "program/installation.h"

namespace plab::completion
{
namespace
{

using program::Candidate;
using program::Values;
using program::Wanted;

constexpr unsigned kAtMost = 2;  ///< s: whatever hangs, the terminal goes on

std::optional<model::SceneSpec> scene_in(const Wanted& wanted, plugins::PluginLibrary& library)
{
    const auto blueprint = blueprint::read_blueprint_file(program::file_or_installed(wanted.first("scene")));
    if (!blueprint) return {};
    auto scene = model::compile(*blueprint, library);
    if (!scene) return {};
    return scene.take();
}

std::string type_of(const model::SceneSpec& scene, std::string_view id)
{
    for (const model::ComponentSpec& c : scene.components)
        if (c.id == id) return c.type;
    return {};
}

const model::TypeSummary* find(const std::vector<model::TypeSummary>& types, const std::string& name)
{
    for (const model::TypeSummary& t : types)
        if (t.name == name) return &t;
    return nullptr;
}

std::vector<Candidate> types(const std::vector<model::TypeSummary>& all, const std::string& family, const std::string& before)
{
    std::vector<Candidate> out;
    for (const model::TypeSummary& t : all)
        if (family.empty() || t.family == family) out.push_back({before + t.name, t.doc});
    return out;
}

/// "gears" becomes "gears=", and that "gears=Constraint/..": a type of the same family.
Values exchanges(const model::SceneSpec& scene, const std::vector<model::TypeSummary>& all, const std::string& before,
                 std::string_view begun)
{
    Values out;
    const std::size_t equal = begun.find('=');
    if (equal == std::string_view::npos)
    {
        out.go_on = true;
        for (const model::ComponentSpec& c : scene.components)
            if (!c.type.empty()) out.candidates.push_back({before + c.id + "=", c.type});
        return out;
    }
    const model::TypeSummary* const old = find(all, type_of(scene, begun.substr(0, equal)));
    // --vary takes a list.
    const std::size_t comma = begun.rfind(',');
    const std::size_t kept = comma == std::string_view::npos ? equal + 1 : comma + 1;
    if (old != nullptr) out.candidates = types(all, old->family, before + std::string(begun.substr(0, kept)));
    return out;
}

/// "red" becomes "red.", and that "red.position", of the fields of these kinds; `after` ends it.
Values fields(const model::SceneSpec& scene, const std::vector<model::TypeSummary>& all, const std::string& before, std::string_view begun,
              bool has_outputs, const std::string& after)
{
    Values out;
    out.go_on = !after.empty();
    for (const model::ComponentSpec& c : scene.components)
    {
        const model::TypeSummary* const type = find(all, c.type);
        if (type == nullptr) continue;
        const std::string head = before + c.id + ".";
        if (!begun.starts_with(c.id + "."))
        {
            out.candidates.push_back({head, c.type}), out.go_on = true;
            continue;
        }
        for (const model::FieldSummary& f : type->fields)
            if (f.kind != "output" || has_outputs)
                out.candidates.push_back({head + f.name + after, f.doc + (f.unit.empty() ? std::string() : ", " + f.unit)});
    }
    return out;
}

bool is_one_of(const std::string& word, std::initializer_list<std::string_view> words)
{
    for (const std::string_view w : words)
        if (word == w) return true;
    return false;
}

}  // namespace

Values scene_values(const Wanted& wanted)
{
    alarm(kAtMost);
    Values out;
    const std::string& option = wanted.option;
    if (option == "scene" || is_one_of(wanted.value, {"FILE", "[FILE]", "DIR"}))
    {
        out.are_files = true;
        return out;
    }
    const bool is_reference = wanted.value == "[TYPE]";
    const bool is_exchange = is_one_of(option, {"--swap", "--vary", "--algorithm", "--reference-algorithm"});
    const bool is_quantity = is_one_of(option, {"--quantity", "--scale"});
    if (!is_reference && !is_exchange && !is_quantity && option != "--set") return out;
    plugins::PluginLibrary library;
    const std::vector<model::TypeSummary> all = library.summaries();
    if (is_reference) out.candidates = types(all, {}, {});
    const auto scene = is_reference ? std::nullopt : scene_in(wanted, library);
    if (!scene) return out;
    // "120:" before the id is a step.
    const std::size_t colon = wanted.begun.find(':');
    const std::string before = colon == std::string::npos ? std::string() : wanted.begun.substr(0, colon + 1);
    const std::string_view begun = std::string_view(wanted.begun).substr(before.size());
    if (is_exchange) return exchanges(*scene, all, before, begun);
    return fields(*scene, all, before, begun, is_quantity, option == "--quantity" ? "" : "=");
}

}  // namespace plab::completion
