// A type describes itself: words, units, defaults, commands, manifest, stamp.
#include <algorithm>
#include <filesystem>
#include <set>

#include "model/units.h"
#include "model/values.h"
#include "subjects.h"

using namespace plab;
using namespace plab::test;
namespace fs = std::filesystem;

namespace
{

bool is_snake_case(const std::string& name)
{
    const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
    return !name.empty() && name.front() >= 'a' && name.front() <= 'z' && name.back() != '_' && name.find("__") == std::string::npos &&
           std::all_of(name.begin(), name.end(), fits);
}

/// A doc is a remark in a list: no capital sentence mark at its end, no blanks around it.
bool is_doc(const std::string& text) { return !text.empty() && text.front() != ' ' && text.back() != ' ' && text.back() != '.'; }

bool can_have_unit(FieldType type)
{
    return type == FieldType::Real || type == FieldType::Vector || type == FieldType::Matrix || type == FieldType::RealList;
}

void check_unit(const Field& field)
{
    CHECK((field.unit == unit::one) == field.unit.symbol.empty());
    if (field.unit == unit::one) return;
    CHECK(can_have_unit(field.type));
    const auto parsed = model::parse_unit(field.unit.symbol);
    REQUIRE_MESSAGE(parsed.ok(), "no blueprint can contain the unit '", field.unit.symbol, "'");
    CHECK(model::unit_fits(parsed->dimension, field.unit.dimension));
    CHECK_MESSAGE(parsed->to_si(1) == 1, field.unit.symbol, " is no SI unit");
}

void check_default(const Field& field)
{
    const bool settable = field.kind == FieldKind::Param || field.kind == FieldKind::State;
    if (!settable || field.required) return;
    Value value = field.fallback;
    const auto fits = model::check_value(value, field);
    CHECK_MESSAGE(fits.ok(), reasons(fits));
    CHECK(value == field.fallback);
    const auto again = model::parse_value(model::format_value(field.fallback), field);
    if (field.type == FieldType::Text || field.type == FieldType::EntryList) return;
    REQUIRE_MESSAGE(again.ok(), "the printed default does not read back: ", model::format_value(field.fallback));
    CHECK(*again == field.fallback);
}

void check_role(const Role& role)
{
    CHECK(is_snake_case(role.name));
    CHECK(is_doc(role.doc));
    if (role.default_type.empty()) return;
    const auto made = library().require(role.default_type);
    REQUIRE_MESSAGE(made.ok(), "the default type is unknown: ", role.default_type);
    CHECK(std::find(role.facets.begin(), role.facets.end(), (*made)->info.facet) != role.facets.end());
}

void check_command(const CommandInfo& command)
{
    const std::size_t slash = command.name.find('/');
    CHECK_MESSAGE((slash != std::string::npos && slash > 0 && slash + 1 < command.name.size()), "a command is called Kind/Verb");
    CHECK(is_doc(command.doc));
}

/// What a user has to know to choose among the algorithms of a family.
void check_algorithm(const TypeInfo& info)
{
    CHECK_MESSAGE((info.order > 0 || is_doc(info.accuracy)), "neither an order nor an accuracy");
    for (const std::string* text : {&info.strengths, &info.cost, &info.limits, &info.source}) CHECK(is_doc(*text));
}

std::vector<std::string> sorted(std::vector<std::string> names)
{
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

TEST_CASE("there are types, and each has a scene to be tested in")
{
    CHECK(!tested_types().empty());
    CHECK_MESSAGE(library().problems().empty(), first_error(library().problems()));
    for (const std::string& why : subjects_missing()) FAIL_CHECK(why);
    CHECK(subjects().size() + subjects_missing().size() == tested_types().size());
}

TEST_CASE("every type says what it is, field by field, role by role, command by command")
{
    for (const std::string& name : tested_types())
    {
        CAPTURE(name);
        const auto type = library().require(name);
        REQUIRE_MESSAGE(type.ok(), reasons(type));
        const TypeInfo& info = (*type)->info;
        CHECK(info.name == name);
        CHECK(is_doc(info.doc));
        CHECK(!info.family.empty());
        CHECK((*type)->why_not_exchangeable(**type).empty());
        std::set<std::string> names;
        for (const Field& field : (*type)->schema.fields())
        {
            CAPTURE(field.name);
            CHECK(is_snake_case(field.name));
            CHECK(names.insert(field.name).second);
            CHECK(is_doc(field.doc));
            check_unit(field);
            check_default(field);
        }
        for (const Role& role : (*type)->schema.roles())
        {
            CAPTURE(role.name);
            CHECK(names.insert(role.name).second);
            check_role(role);
        }
        names.clear();
        for (const CommandInfo& command : info.commands)
        {
            CAPTURE(command.name);
            CHECK(names.insert(command.name).second);
            check_command(command);
        }
        for (const char* kind : {"Solver/", "Constraint/", "Response/", "Manager/", "Resolution/"})
            if (name.starts_with(kind)) check_algorithm(info);
    }
}

TEST_CASE("manifest and plugin name the same types, and the stamp fits")
{
    for (const std::string& path : tested_plugins())
    {
        CAPTURE(path);
        const std::string name = fs::path(path).stem().string();
        const auto opened = plugins::open_plugin(path);
        REQUIRE_MESSAGE(opened.ok(), reasons(opened));
        CHECK(opened->name == name);
        const auto info = library().load_plugin(path);
        const auto manifest = plugins::read_manifest(fs::path(path).replace_extension(".manifest").string());
        REQUIRE(info.ok());
        REQUIRE_MESSAGE(manifest.ok(), reasons(manifest));
        CHECK(manifest->types == sorted(info->types));
        for (const std::string& type : info->types)
        {
            const auto required = library().require(type);
            REQUIRE(required.ok());
            CHECK((*required)->plugin == name);
        }
    }
}
