/// Text to values and back.
#include <doctest/doctest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/numbers.h"
#include "model/values.h"

using namespace plab;
using namespace plab::model;

namespace
{

constexpr double kPi = std::numbers::pi;
constexpr double kInf = std::numeric_limits<double>::infinity();

Field field(FieldType type, Unit unit = unit::one)
{
    Field f;
    f.name = "x";
    f.type = type;
    f.unit = unit;
    return f;
}

std::string error_of(std::string_view text, const Field& f)
{
    const Result<Value> value = parse_value(text, f);
    return value ? "accepted as " + format_value(*value) : value.error().reason;
}

}  // namespace

TEST_CASE("numbers and their units")
{
    struct Row
    {
        const char* text;
        Unit unit;
        double wanted;
    };
    const Unit per_second{"1/s", {{0, 0, -1, 0}}}, pascal{"Pa", {{-1, 1, -2, 0}}}, watt{"W", {{2, 1, -3, 0}}};
    const Unit newton_per_radian{"N m/rad", {{2, 1, -2, -1}}};
    const Row rows[] = {
        {"2", unit::metre, 2},
        {" 2.5\t", unit::metre, 2.5},
        {"+2", unit::one, 2},
        {".5", unit::one, 0.5},
        {"-1e3", unit::one, -1000},
        {"1/240", unit::second, 1.0 / 240},
        {"-20/40", unit::one, -0.5},
        {"7 cm", unit::metre, 0.07},
        {"5 mm", unit::metre, 0.005},
        {"3 km", unit::metre, 3000},
        {"1/2 m", unit::metre, 0.5},
        {"250 g", unit::kilogram, 0.25},
        {"2 t", unit::kilogram, 2000},
        {"2 ms", unit::second, 0.002},
        {"3 us", unit::second, 3e-6},
        {"2 min", unit::second, 120},
        {"1 h", unit::second, 3600},
        {"180 deg", unit::radian, kPi},
        {"90 deg", unit::radian, kPi / 2},
        {"1 rev", unit::radian, 2 * kPi},
        {"2 turn", unit::radian, 4 * kPi},
        {"60 rpm", unit::radian_per_second, 2 * kPi},
        {"30 rev/min", unit::radian_per_second, kPi},
        {"180 deg/s", unit::radian_per_second, kPi},
        {"3 rad/s", unit::radian_per_second, 3},
        {"50 Hz", per_second, 50},
        {"2 1/s", per_second, 2},
        {"2 s^-1", per_second, 2},
        {"36 km/h", unit::metre_per_second, 10},
        {"9.81 m/s^2", unit::metre_per_second2, 9.81},
        {"981 cm/s^2", unit::metre_per_second2, 9.81},
        {"1 g/cm^3", unit::kilogram_per_metre3, 1000},
        {"2 kN", unit::newton, 2000},
        {"2 mN", unit::newton, 0.002},
        {"3 kg m/s^2", unit::newton, 3},
        {"3 kg*m/s^2", unit::newton, 3},
        {"4 N m", unit::newton_metre, 4},
        {"4 J", unit::newton_metre, 4},
        {"4 N m", unit::joule, 4},
        {"4 N m s", unit::newton_metre_second, 4},
        {"4 N m s/rad", unit::newton_metre_second_per_radian, 4},
        {"4 N m s", unit::newton_metre_second_per_radian, 4},
        {"5 N m/rad", newton_per_radian, 5},
        {"1 N m/deg", newton_per_radian, 180 / kPi},
        {"4 N s/m", unit::kilogram_per_second, 4},
        {"10000 g cm^2", unit::kilogram_metre2, 0.001},
        {"2 W", watt, 2},
        {"2 kPa", pascal, 2000},
        {"2 N / m^2", pascal, 2},
        {"1e-320", unit::one, 1e-320},
    };
    for (const Row& row : rows)
    {
        CAPTURE(row.text);
        const Result<Value> value = parse_value(row.text, field(FieldType::Real, row.unit));
        CHECK_MESSAGE(value.ok(), (value ? "" : value.error().reason));
        if (value) CHECK(std::get<double>(*value) == doctest::Approx(row.wanted).epsilon(1e-15));
    }
    // Exact: a decimal with a decimal unit is the double nearest to it, half a turn is the double pi.
    CHECK(std::get<double>(*parse_value("35 cm", field(FieldType::Real, unit::metre))) == 0.35);
    CHECK(std::get<double>(*parse_value("180 deg", field(FieldType::Real, unit::radian))) == kPi);
}

TEST_CASE("numbers that are refused, and why")
{
    struct Row
    {
        const char* text;
        Unit unit;
        const char* reason;
    };
    const Row rows[] = {
        {"", unit::one, "x is empty"},
        {"  ", unit::one, "x is empty"},
        {"abc", unit::one, "x must be a number, not 'abc'"},
        {"1,5", unit::one, "x: '1,5': use a point, not a comma, in numbers, and spaces between them"},
        {"nan", unit::one, "x: 'nan' is not a finite number"},
        {"-NaN", unit::one, "x: '-NaN' is not a finite number"},
        {"inf", unit::one, "x must be finite, not inf"},
        {"-infinity", unit::one, "x must be finite, not -inf"},
        {"0x10", unit::one, "x: '0x10': write the number in decimal notation"},
        {"1e400", unit::one, "x: '1e400' is out of range"},
        {"1e308 km", unit::metre, "x is out of range"},
        {"1/0", unit::one, "x: '1/0' divides by zero"},
        {"1/2/3", unit::one, "x: '1/2/3' is not a number"},
        {"1.5x", unit::one, "x: '1.5x' is not a number"},
        {"--1", unit::one, "x: '--1' is not a number"},
        {"+-1", unit::one, "x: '+-1' is not a number"},
        {"1e", unit::one, "x: '1e' is not a number"},
        {"30deg", unit::radian, "x: '30deg': put a space between number and unit, '30 deg'"},
        {"1 2", unit::one, "x needs 1 number, has 2"},
        {"30 deg", unit::one, "x is a pure number and takes no unit such as 'deg'"},
        {"2 m", unit::radian, "x must be in rad (or deg, rev, turn, mrad), not in 'm'"},
        {"2 s", unit::metre, "x must be in m (or cm, mm, km, um), not in 's'"},
        {"2 Hz", unit::radian_per_second, "x must be in rad/s (or rpm), not in 'Hz'"},
        {"2 N m/rad", unit::newton_metre, "x must be in N m (or J, kJ), not in 'N m/rad'"},
        {"2 parsec", unit::metre, "x: unknown unit 'parsec'"},
        {"2 degg", unit::radian, "x: unknown unit 'degg', did you mean 'deg'?"},
        {"2 m^", unit::metre, "x: 'm^' has an exponent that is not a small whole number"},
        {"2 m^99", unit::metre, "x: 'm^99' has an exponent that is not a small whole number"},
        {"2 m^12 m^12", unit::metre, "x: 'm^12 m^12' is not a sensible unit"},
        {"2 m/", unit::metre, "x: 'm/' is not a unit"},
        {"2 m 3", unit::metre, "x: 'm 3' is not a unit"},
    };
    for (const Row& row : rows)
    {
        CAPTURE(row.text);
        CHECK(error_of(row.text, field(FieldType::Real, row.unit)) == row.reason);
    }
}

TEST_CASE("values of other types")
{
    const auto vector = [](const char* text, Unit unit = unit::metre)
    { return std::get<Vec3>(*parse_value(text, field(FieldType::Vector, unit))); };
    CHECK(vector("1 2 3") == Vec3{1, 2, 3});
    CHECK(vector("0 0 30 cm") == Vec3{0, 0, 0.3});
    CHECK(error_of("1 2", field(FieldType::Vector)) == "x needs 3 numbers, has 2");
    CHECK(error_of("1,2,3", field(FieldType::Vector)) == "x: '1,2,3': use a point, not a comma, in numbers, and spaces between them");
    CHECK(error_of("1 , 2", field(FieldType::Vector)) == "x: ',': use a point, not a comma, in numbers, and spaces between them");

    for (const char* yes : {"true", "yes", "1"}) CHECK(std::get<bool>(*parse_value(yes, field(FieldType::Boolean))));
    for (const char* no : {"false", "no", " 0 "}) CHECK_FALSE(std::get<bool>(*parse_value(no, field(FieldType::Boolean))));
    CHECK(error_of("TRUE?", field(FieldType::Boolean)) == "x must be true or false, not 'TRUE?'");

    CHECK(std::get<std::int64_t>(*parse_value("-12", field(FieldType::Integer))) == -12);
    CHECK(error_of("1.5", field(FieldType::Integer)) == "x: '1.5' is not a whole number");
    CHECK(error_of("9223372036854775808", field(FieldType::Integer)) == "x: '9223372036854775808' is out of range");
    CHECK(error_of("3 m", field(FieldType::Integer)) == "x takes no unit such as 'm'");

    CHECK(std::get<Reals>(*parse_value("1 2 cm", field(FieldType::RealList, unit::metre))) == Reals{0.01, 0.02});
    CHECK(std::get<Reals>(*parse_value("", field(FieldType::RealList))).empty());
    CHECK(std::get<Integers>(*parse_value("0 1\n2", field(FieldType::IntegerList))) == Integers{0, 1, 2});
    CHECK(std::get<std::string>(*parse_value(" as it is ", field(FieldType::Text))) == " as it is ");
    CHECK(error_of("x", field(FieldType::Opaque)) == "x has no text form");
}

TEST_CASE("rotations as quaternion and as axis with angle")
{
    const Field f = field(FieldType::Rotation);
    CHECK(std::get<Quat>(*parse_value("2 0 0 0", f)) == Quat{1, 0, 0, 0});
    CHECK(std::get<Quat>(*parse_value("0 0 0 1e-200", f)) == Quat{0, 0, 0, 1});
    const Quat half = std::get<Quat>(*parse_value("axis 0 0 2 180 deg", f));
    CHECK(std::fabs(half.w) < 1e-15);
    CHECK(half.z == doctest::Approx(1).epsilon(1e-15));
    const Quat third = std::get<Quat>(*parse_value("axis 1 1 1 1/3 rev", f));  // x to y to z to x
    const Vec3 y = rotate(third, {1, 0, 0});
    CHECK(y.y == doctest::Approx(1).epsilon(1e-14));
    CHECK(error_of("0 0 0 0", f) == "x must not be the zero quaternion");
    CHECK(error_of("axis 0 0 0 1", f) == "x has an axis of length zero");
    CHECK(error_of("axis 0 0 1", f) == "x needs 'axis x y z angle', has 3");
    CHECK(error_of("axis 0 0 1 2 m", f) == "x must be in rad (or deg, rev, turn, mrad), not in 'm'");
    CHECK(error_of("1 0 0", f) == "x needs 4 numbers (w x y z) or 'axis x y z angle', has 3");
    CHECK(error_of("1 0 0 0 deg", f) == "x is a pure number and takes no unit such as 'deg'");
}

TEST_CASE("matrices by three and by six numbers")
{
    const Field f = field(FieldType::Matrix, unit::kilogram_metre2);
    CHECK(std::get<Mat3>(*parse_value("1 2 3", f)) == Mat3::diagonal(1, 2, 3));
    const Mat3 full = std::get<Mat3>(*parse_value("1 2 3 4 5 6 kg m^2", f));
    CHECK(full == Mat3{{{1, 4, 5}, {4, 2, 6}, {5, 6, 3}}});
    CHECK(error_of("1 2 3 4", f) == "x needs 3 numbers (xx yy zz) or 6 (xx yy zz xy xz yz), has 4");
    Value skew(Mat3{{{1, 1, 0}, {0, 1, 0}, {0, 0, 1}}});
    CHECK(check_value(skew, f).error().reason == "x must be symmetric");
}

TEST_CASE("the messages of rules say what would be right")
{
    Field f = field(FieldType::Real, unit::kilogram);
    f.name = "mass";
    const auto with = [&](Rule::Kind kind, double bound) { return f.rules.assign(1, {kind, bound, {}}), f; };
    CHECK(error_of("-1", with(Rule::Kind::MoreThan, 0)) == "mass must be positive, not -1");
    CHECK(error_of("0", with(Rule::Kind::MoreThan, 0)) == "mass must be positive, not 0");
    CHECK(error_of("2", with(Rule::Kind::MoreThan, 2)) == "mass must be more than 2, not 2");
    CHECK(error_of("-1 g", with(Rule::Kind::AtLeast, 0)) == "mass must be 0 or more, not -0.001");
    CHECK(error_of("1", with(Rule::Kind::AtLeast, 2)) == "mass must be at least 2, not 1");
    CHECK(error_of("3", with(Rule::Kind::AtMost, 2)) == "mass must be at most 2, not 3");
    CHECK(error_of("0", with(Rule::Kind::NonZero, 0)) == "mass must not be zero");
    CHECK(parse_value("1", with(Rule::Kind::AtLeast, 1)).ok());
    CHECK(parse_value("1", with(Rule::Kind::AtMost, 1)).ok());

    Field list = field(FieldType::RealList);
    list.rules.push_back({Rule::Kind::MoreThan, 0, {}});
    CHECK(error_of("1 2 -3", list) == "x must be positive, not -3");

    Field choice = field(FieldType::Text);
    choice.rules.push_back({Rule::Kind::OneOf, 0, {"simple", "hash", "sweep"}});
    CHECK(std::get<std::string>(*parse_value(" hash ", choice)) == "hash");
    CHECK(error_of("hsah", choice) == "x must be 'simple', 'hash' or 'sweep', not 'hsah', did you mean 'hash'?");
}

TEST_CASE("directions are normalised, and left unchanged if they already are")
{
    Field f = field(FieldType::Vector);
    f.rules.push_back({Rule::Kind::UnitLength, 0, {}});
    CHECK(std::get<Vec3>(*parse_value("0 3 4", f)) == Vec3{0, 0.6, 0.8});
    CHECK(std::get<Vec3>(*parse_value("0 0 1e-300", f)) == Vec3{0, 0, 1});
    CHECK(std::get<Vec3>(*parse_value("0 0 1e300", f)) == Vec3{0, 0, 1});
    CHECK(error_of("0 0 0", f) == "x must not be zero: it is a direction");
    const Vec3 once = std::get<Vec3>(*parse_value("1 2 3", f));
    CHECK(std::get<Vec3>(*parse_value(format_value(once), f)) == once);
}

TEST_CASE("infinity is accepted where the rule allows it")
{
    Field f = field(FieldType::Real);
    f.may_be_infinite = true;
    CHECK(std::get<double>(*parse_value("inf", f)) == kInf);
    CHECK(std::get<double>(*parse_value("-Infinity", f)) == -kInf);
    Value not_a_number(std::nan(""));
    CHECK(check_value(not_a_number, f).error().reason == "x must be a number, not nan");
}

TEST_CASE("a value of another type is refused, a whole number is a number")
{
    Value text(std::string("1")), whole(std::int64_t{3}), nothing;
    const Field f = field(FieldType::Real);
    CHECK(check_value(text, f).error().reason == "x must be a number, not a text");
    CHECK(check_value(nothing, f).error().reason == "x must be a number, not nothing");
    CHECK(check_value(whole, f).ok());
    CHECK(std::get<double>(whole) == 3.0);
}

TEST_CASE("printed values read back to the same bits")
{
    const double numbers[] = {0.1, -0.0, 1.0 / 3, 1e-7, 123456789012345678.0, 5e-324, 1e22, 100000, 6.02e23, kPi};
    for (const double x : numbers)
    {
        const double back = std::get<double>(*parse_value(format_real(x), field(FieldType::Real)));
        CHECK(back == x);
        CHECK(std::signbit(back) == std::signbit(x));
    }
    CHECK(format_real(0.1) == "0.1");
    CHECK(format_real(100000) == "100000");
    CHECK(format_real(1e-7) == "1e-07");
    const auto round_trip = [](const Value& value)
    {
        const Result<Value> back = parse_value(format_value(value), field(type_of(value)));
        return back.ok() && *back == value;
    };
    CHECK(round_trip(Value(true)));
    CHECK(round_trip(Value(std::int64_t{-7})));
    CHECK(round_trip(Value(Vec3{0.1, -2, 1e-9})));
    CHECK(round_trip(Value(normalized(Quat{1, 2, 3, 4}))));
    CHECK(round_trip(Value(Mat3{{{1, 0.1, 0}, {0.1, 2, 0}, {0, 0, 3}}})));
    CHECK(round_trip(Value(std::string("a b\n c"))));
    CHECK(round_trip(Value(Reals{1, 0.2})));
    CHECK(round_trip(Value(Integers{1, -2})));
    CHECK(round_trip(Value(Entries{{"count", 1.5}, {"on", true}, {"label", std::string("it's 'so'")}, {"empty", std::string()}})));
}

TEST_CASE("entries")
{
    const Field f = field(FieldType::EntryList);
    const Entries wanted{{"a", 1.0}, {"b", std::string("x y")}};
    CHECK(std::get<Entries>(*parse_value("a=1 b='x y'", f)) == wanted);
    CHECK(error_of("a=1 a=2", f) == "x has two entries named 'a'");
    CHECK(error_of("a 1", f) == "x: entries are written name=value");
    CHECK(error_of("a='1", f) == "x: the text of 'a' has no closing quote");
    CHECK(error_of("a=inf", f) == "x must be finite, not inf");
}

TEST_CASE("the process's locale has no effect")
{
    const std::string before = std::setlocale(LC_ALL, nullptr);
    for (const char* locale : {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8"})
        if (std::setlocale(LC_ALL, locale)) break;
    CHECK(std::get<double>(*parse_value("1.5", field(FieldType::Real))) == 1.5);
    CHECK(format_real(1.5) == "1.5");
    CHECK_FALSE(parse_value("1,5", field(FieldType::Real)).ok());
    std::setlocale(LC_ALL, before.c_str());
}
