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

// Values to text.

namespace
{

std::string join(std::initializer_list<double> numbers)
{
    std::string out;
    for (const double x : numbers) out += (out.empty() ? "" : " ") + format_real(x);
    return out;
}

/// Whether it is +0, bit for bit: the elements that a matrix of three numbers leaves out.
bool is_plain_zero(double x) { return x == 0 && !std::signbit(x); }

std::string format_matrix(const Mat3& a)
{
    if (is_plain_zero(a(0, 1)) && is_plain_zero(a(0, 2)) && is_plain_zero(a(1, 2))) return join({a(0, 0), a(1, 1), a(2, 2)});
    return join({a(0, 0), a(1, 1), a(2, 2), a(0, 1), a(0, 2), a(1, 2)});
}

struct Formatter
{
    std::string operator()(std::monostate) const { return {}; }
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t n) const { return std::to_string(n); }
    std::string operator()(double x) const { return format_real(x); }
    std::string operator()(const Vec3& v) const { return join({v.x, v.y, v.z}); }
    std::string operator()(const Quat& q) const { return join({q.w, q.x, q.y, q.z}); }
    std::string operator()(const Mat3& a) const { return format_matrix(a); }
    std::string operator()(const std::string& text) const { return text; }
    std::string operator()(const Reals& list) const
    {
        std::string out;
        for (const double x : list) out += (out.empty() ? "" : " ") + format_real(x);
        return out;
    }
    std::string operator()(const Integers& list) const
    {
        std::string out;
        for (const std::int64_t n : list) out += (out.empty() ? "" : " ") + std::to_string(n);
        return out;
    }
    std::string operator()(const Entries& entries) const { return format_entries(entries); }
};

}  // namespace

std::string format_value(const Value& value) { return std::visit(Formatter{}, value); }

// The numbers of a value.

std::size_t number_count(const Value& v)
{
    switch (type_of(v))
    {
        case FieldType::Boolean:
        case FieldType::Integer:
        case FieldType::Real:
            return 1;
        case FieldType::Vector:
            return 3;
        case FieldType::Rotation:
            return 4;
        case FieldType::RealList:
            return std::get<Reals>(v).size();
        default:
            return 0;
    }
}

void append_numbers(const Value& v, std::vector<double>& out)
{
    if (const auto* b = std::get_if<bool>(&v)) out.push_back(*b ? 1 : 0);
    if (const auto* n = std::get_if<std::int64_t>(&v)) out.push_back(static_cast<double>(*n));
    if (const auto* d = std::get_if<double>(&v)) out.push_back(*d);
    if (const auto* x = std::get_if<Vec3>(&v)) out.insert(out.end(), {x->x, x->y, x->z});
    if (const auto* q = std::get_if<Quat>(&v)) out.insert(out.end(), {q->w, q->x, q->y, q->z});
    if (const auto* list = std::get_if<Reals>(&v)) out.insert(out.end(), list->begin(), list->end());
}

std::vector<std::string> number_suffixes(const Value& v)
{
    if (std::holds_alternative<Vec3>(v)) return {".x", ".y", ".z"};
    if (std::holds_alternative<Quat>(v)) return {".w", ".x", ".y", ".z"};
    std::vector<std::string> out(number_count(v));
    if (std::holds_alternative<Reals>(v))
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = "." + std::to_string(k + 1);
    return out;
}

}  // namespace plab::model
