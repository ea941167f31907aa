// Bad values are refused where they stand, by name, and nothing changes: in a blueprint and in a request.
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "model/units.h"
#include "subjects.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// `word` as the last of the numbers that the field takes, the others 1.
std::string last_is(const std::string& word, FieldType type)
{
    std::string out;
    for (int i = 1; i < count_of_reals(type); ++i) out += "1 ";
    return out + word;
}

std::string text_of(double x)
{
    std::ostringstream out;
    out.precision(17);
    out << x;
    return out.str();
}

void add_breaking(std::vector<std::string>& out, const Field& field, const Rule& rule)
{
    const double margin = std::fmax(1, std::fabs(rule.bound));
    switch (rule.kind)
    {
        case Rule::Kind::MoreThan:
            out.push_back(last_is(text_of(rule.bound), field.type));
            [[fallthrough]];
        case Rule::Kind::AtLeast:
            out.push_back(last_is(text_of(rule.bound - margin), field.type));
            break;
        case Rule::Kind::AtMost:
            out.push_back(last_is(text_of(rule.bound + margin), field.type));
            break;
        case Rule::Kind::NonZero:
        case Rule::Kind::UnitLength:
            out.push_back(field.type == FieldType::Vector ? "0 0 0" : "0");
            break;
        case Rule::Kind::OneOf:
            out.push_back("none of these");
            break;
    }
}

void add_misshapen(std::vector<std::string>& out, const Field& field)
{
    switch (field.type)
    {
        case FieldType::Boolean:
            out.insert(out.end(), {"maybe", "2", ""});
            break;
        case FieldType::Integer:
        case FieldType::IntegerList:
            out.insert(out.end(), {"many", "1.5", "nan", "1 kg", "99999999999999999999"});
            break;
        case FieldType::Rotation:
            out.insert(out.end(), {"0 0 0 0", "1 0 0", "axis 0 0 0 1"});
            break;
        case FieldType::EntryList:
            out.insert(out.end(), {"k", "k=1 k=2", "k=nan", "=1"});
            break;
        default:
            break;
    }
}

/// Texts that break the field's type or one of its rules.
std::vector<std::string> bad_texts(const Field& field)
{
    std::vector<std::string> out;
    add_misshapen(out, field);
    if (const int count = count_of_reals(field.type))
    {
        for (const char* word : {"many", "nan", "-nan", "0,5", "0x10", "1e999"}) out.push_back(last_is(word, field.type));
        if (!field.may_be_infinite) out.insert(out.end(), {last_is("inf", field.type), last_is("-inf", field.type)});
        const std::string unit = model::unit_fits(unit::kilogram.dimension, field.unit.dimension) ? " m" : " kg";
        out.push_back(last_is("1", field.type) + unit);
        if (field.type != FieldType::RealList) out.insert(out.end(), {std::string(), last_is("1", field.type) + " 1 1 1 1"});
        if (count > 1) out.push_back("1 2");
    }
    for (const Rule& rule : field.rules) add_breaking(out, field, rule);
    return out;
}

/// Values that break the field's type or finiteness, as a program may send them.
std::vector<Value> bad_values(const Field& field)
{
    std::vector<Value> out;
    out.push_back({});
    if (field.type != FieldType::Text) out.push_back(std::string("many"));
    if (field.type != FieldType::Boolean) out.push_back(true);
    for (const double x : {kNan, kInfinity, -kInfinity})
    {
        if (std::isinf(x) && field.may_be_infinite) continue;
        out.push_back(x);
        out.push_back(Vec3{0, x, 1});
        out.push_back(Quat{1, 0, x, 0});
        out.push_back(Mat3::diagonal(1, x, 1));
        out.push_back(Reals{1, x});
        out.push_back(Entries{{"k", x}});
    }
    out.push_back(Quat{0, 0, 0, 0});
    out.push_back(Mat3{{{1, 2, 0}, {3, 1, 0}, {0, 0, 1}}});
    return out;
}

void check_names(const Errors& errors, const std::string& field)
{
    const bool named = std::any_of(errors.begin(), errors.end(), [&](const Error& e) { return e.reason.find(field) != std::string::npos; });
    CHECK_MESSAGE(named, "the message does not name the field: ", first_error(errors));
    const bool placed =
        std::any_of(errors.begin(), errors.end(), [](const Error& e) { return e.element.find(kSubject) != std::string::npos; });
    CHECK_MESSAGE(placed, "the message does not name the component: ", first_error(errors));
}

void check_refused(simulation::Simulation& simulation, const std::string& field, simulation::GivenValue value)
{
    const std::uint64_t before = simulation.state_hash();
    const std::vector<std::uint8_t> cells = simulation.world().backup().cells;
    simulation::Request request;
    request.operations.push_back(simulation::SetOperation{kSubject, field, std::move(value)});
    const simulation::Reply reply = simulation.carry_out_now(request);
    CHECK(!reply.done);
    CHECK(simulation.state_hash() == before);
    CHECK(simulation.world().backup().cells == cells);
    if (!reply.done) check_names(reply.errors, field);
}

}  // namespace

TEST_CASE("a blueprint with a bad value is refused, and the reason names component and field")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        CHECK(model::compile(subject.blueprint, library()).ok());
        for (const Field& field : schema_of(subject).fields())
        {
            if (!settable(field)) continue;
            CAPTURE(field.name);
            for (const std::string& text : bad_texts(field))
            {
                CAPTURE(text);
                const auto scene = model::compile(with_field(subject.blueprint, field.name, text), library());
                CHECK(!scene.ok());
                if (!scene) check_names(scene.errors(), field.name);
            }
        }
    }
}

TEST_CASE("a field that must be given, and one that does not exist, are named")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        const auto unknown = model::compile(with_field(subject.blueprint, "no_such_field", "1"), library());
        REQUIRE(!unknown.ok());
        check_names(unknown.errors(), "no_such_field");
        for (const Field& field : schema_of(subject).fields())
        {
            CAPTURE(field.name);
            model::Blueprint scene = with_field(subject.blueprint, field.name, "1");
            if (field.required) subject_node(scene).parameters.pop_back();
            if (!field.required && settable(field)) continue;
            const auto refused = model::compile(scene, library());
            REQUIRE(!refused.ok());
            check_names(refused.errors(), field.name);
        }
    }
}

TEST_CASE("a request with a bad value is refused, and no bit changes")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        const auto running = started(compiled(subject.blueprint));
        hashes(*running, 10);
        for (const Field& field : schema_of(subject).fields())
        {
            CAPTURE(field.name);
            if (!settable(field))
            {
                check_refused(*running, field.name, std::string("1"));
                continue;
            }
            for (const std::string& text : bad_texts(field))
            {
                CAPTURE(text);
                check_refused(*running, field.name, text);
            }
            const std::vector<Value> values = bad_values(field);
            for (std::size_t i = 0; i < values.size(); ++i)
            {
                CAPTURE(i);
                check_refused(*running, field.name, values[i]);
            }
        }
        check_refused(*running, "no_such_field", std::string("1"));
        const auto untouched = started(compiled(subject.blueprint));
        hashes(*untouched, 10);
        CHECK(hashes(*running, 50) == hashes(*untouched, 50));
    }
}
