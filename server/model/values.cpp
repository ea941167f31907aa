/// Text to values.

#include "model/values.h"

#include <algorithm>
#include <cmath>

#include "model/entries.h"
#include "model/numbers.h"
#include "model/text.h"
#include "model/units.h"
#include "plab/rotation.h"

namespace plab::model
{

std::string subject_of(const Field& field) { return field.name.empty() ? "the value" : field.name; }

namespace
{

/// The field's name as the subject of a sentence.
Error complain(const Field& field, const std::string& why) { return reason(subject_of(field) + ": " + why); }

/// Numbers and the unit after them, already converted to SI.
struct Numbers
{
    std::vector<double> values;
    std::string unit;
};

/// The unit in the text of a field; one of another dimension is refused.
Result<UnitFactor> parse_fitting_unit(std::string_view text, const Unit& declared, const Field& field)
{
    Result<UnitFactor> written = parse_unit(text);
    if (!written) return complain(field, written.error().reason);
    if (unit_fits(written->dimension, declared.dimension)) return written;
    if (declared == unit::one) return reason(subject_of(field) + " is a pure number and takes no unit such as " + quoted(text));
    return reason(subject_of(field) + " must be in " + describe_unit(declared) + ", not in " + quoted(text));
}

/// Words as long as they are numbers, then a unit up to the end.
Result<Numbers> parse_numbers(std::string_view text, const Field& field)
{
    Numbers out;
    std::string_view rest = trimmed(text);
    if (rest.empty()) return reason(subject_of(field) + " is empty");
    while (!rest.empty())
    {
        const std::string_view word = rest.substr(0, rest.find_first_of(" \t\n\r"));
        if (!looks_like_number(word)) break;
        Result<double> number = parse_real(word);
        if (!number) return complain(field, number.error().reason);
        out.values.push_back(*number);
        rest = trimmed(rest.substr(word.size()));
    }
    if (out.values.empty()) return reason(subject_of(field) + " must be a number, not " + quoted(rest));
    out.unit = rest;
    return out;
}

/// Numbers of a field, in SI.
Result<std::vector<double>> parse_reals(std::string_view text, const Field& field)
{
    Result<Numbers> numbers = parse_numbers(text, field);
    if (!numbers) return numbers.errors();
    if (numbers->unit.empty()) return std::move(numbers->values);
    Result<UnitFactor> factor = parse_fitting_unit(numbers->unit, field.unit, field);
    if (!factor) return factor.errors();
    for (double& x : numbers->values)
    {
        const bool was_finite = std::isfinite(x);
        x = factor->to_si(x);
        if (was_finite && !std::isfinite(x)) return reason(subject_of(field) + " is out of range");
    }
    return std::move(numbers->values);
}

Error wrong_count(const Field& field, const std::string& wanted, std::size_t has)
{
    return reason(subject_of(field) + " needs " + wanted + ", has " + std::to_string(has));
}

Result<Value> parse_boolean(std::string_view text, const Field& field)
{
    const std::string_view word = trimmed(text);
    for (const std::string_view yes : {"true", "yes", "1"})
        if (word == yes) return Value(true);
    for (const std::string_view no : {"false", "no", "0"})
        if (word == no) return Value(false);
    if (word.empty()) return reason(subject_of(field) + " is empty");
    return reason(subject_of(field) + " must be true or false, not " + quoted(word));
}

Result<Integers> parse_integers(std::string_view text, const Field& field)
{
    Integers out;
    for (const std::string_view word : split_words(text))
    {
        if (!out.empty() && !looks_like_number(word)) return reason(subject_of(field) + " takes no unit such as " + quoted(word));
        Result<std::int64_t> number = parse_integer(word);
        if (!number) return complain(field, number.error().reason);
        out.push_back(*number);
    }
    return out;
}

Result<Value> parse_single_integer(std::string_view text, const Field& field)
{
    Result<Integers> numbers = parse_integers(text, field);
    if (!numbers) return numbers.errors();
    if (numbers->empty()) return reason(subject_of(field) + " is empty");
    if (numbers->size() != 1) return wrong_count(field, "1 number", numbers->size());
    return Value(numbers->front());
}

Result<Value> parse_vector(std::string_view text, const Field& field)
{
    Result<std::vector<double>> n = parse_reals(text, field);
    if (!n) return n.errors();
    if (n->size() != 3) return wrong_count(field, "3 numbers", n->size());
    return Value(Vec3{(*n)[0], (*n)[1], (*n)[2]});
}

/// "x y z angle [unit]" after the word "axis".
Result<Value> parse_axis_angle(std::string_view text, const Field& field)
{
    Result<Numbers> numbers = parse_numbers(text, field);
    if (!numbers) return numbers.errors();
    const std::vector<double>& n = numbers->values;
    if (n.size() != 4) return wrong_count(field, "'axis x y z angle'", n.size());
    double angle = n[3];
    if (!numbers->unit.empty())
    {
        Result<UnitFactor> factor = parse_fitting_unit(numbers->unit, unit::radian, field);
        if (!factor) return factor.errors();
        angle = factor->to_si(angle);
    }
    const double scale = std::max({std::fabs(n[0]), std::fabs(n[1]), std::fabs(n[2])});
    if (!(scale > 0)) return reason(subject_of(field) + " has an axis of length zero");
    if (!std::isfinite(scale) || !std::isfinite(angle)) return reason(subject_of(field) + " must be finite");
    const Vec3 axis = normalized(Vec3{n[0] / scale, n[1] / scale, n[2] / scale});
    return Value(normalized(exp_rotation(axis * angle)));
}

Result<Value> parse_rotation(std::string_view text, const Field& field)
{
    const std::string_view rest = trimmed(text);
    if (rest.starts_with("axis") && rest.size() > 4 && is_blank(rest[4])) return parse_axis_angle(rest.substr(4), field);
    Field pure = field;
    pure.unit = unit::one;
    Result<std::vector<double>> n = parse_reals(text, pure);
    if (!n) return n.errors();
    if (n->size() != 4) return wrong_count(field, "4 numbers (w x y z) or 'axis x y z angle'", n->size());
    return Value(Quat{(*n)[0], (*n)[1], (*n)[2], (*n)[3]});
}

Result<Value> parse_matrix(std::string_view text, const Field& field)
{
    Result<std::vector<double>> r = parse_reals(text, field);
    if (!r) return r.errors();
    const std::vector<double>& n = *r;
    if (n.size() == 3) return Value(Mat3::diagonal(n[0], n[1], n[2]));
    if (n.size() != 6) return wrong_count(field, "3 numbers (xx yy zz) or 6 (xx yy zz xy xz yz)", n.size());
    return Value(Mat3{{{n[0], n[3], n[4]}, {n[3], n[1], n[5]}, {n[4], n[5], n[2]}}});
}

Result<Value> parse_single_real(std::string_view text, const Field& field)
{
    Result<std::vector<double>> n = parse_reals(text, field);
    if (!n) return n.errors();
    if (n->size() != 1) return wrong_count(field, "1 number", n->size());
    return Value(n->front());
}

/// A list may be empty, a number may not.
Result<Value> parse_list(std::string_view text, const Field& field)
{
    if (field.type == FieldType::IntegerList)
    {
        Result<Integers> n = parse_integers(text, field);
        if (!n) return n.errors();
        return Value(n.take());
    }
    if (trimmed(text).empty()) return Value(Reals{});
    Result<std::vector<double>> n = parse_reals(text, field);
    if (!n) return n.errors();
    return Value(n.take());
}

bool has_options(const Field& field)
{
    for (const Rule& rule : field.rules)
        if (rule.kind == Rule::Kind::OneOf) return true;
    return false;
}

Result<Value> parse_by_type(std::string_view text, const Field& field)
{
    switch (field.type)
    {
        case FieldType::Boolean:
            return parse_boolean(text, field);
        case FieldType::Integer:
            return parse_single_integer(text, field);
        case FieldType::Real:
            return parse_single_real(text, field);
        case FieldType::Vector:
            return parse_vector(text, field);
        case FieldType::Rotation:
            return parse_rotation(text, field);
        case FieldType::Matrix:
            return parse_matrix(text, field);
        case FieldType::Text:
            return Value(std::string(has_options(field) ? trimmed(text) : text));
        case FieldType::RealList:
        case FieldType::IntegerList:
            return parse_list(text, field);
        case FieldType::EntryList:
            return parse_entries(text, field);
        case FieldType::None:
        case FieldType::Opaque:
            break;
    }
    return reason(subject_of(field) + " has no text form");
}

}  // namespace

Result<Value> parse_value(std::string_view text, const Field& field)
{
    Result<Value> value = parse_by_type(text, field);
    if (!value) return value;
    if (Result<void> checked = check_value(*value, field); !checked) return checked.errors();
    return value;
}

}  // namespace plab::model
