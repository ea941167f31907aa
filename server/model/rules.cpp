/// Types, finiteness and rules of values.

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "model/names.h"
#include "model/numbers.h"
#include "model/text.h"
#include "model/values.h"
#include "plab/limits.h"

namespace plab::model
{

namespace
{

/// Directions and rotations this close to length 1 are not changed, so that a printed one reads back to the same bits.
constexpr double kUnitTolerance = 1e-14;

std::string_view type_words(FieldType type)
{
    constexpr std::string_view words[] = {"nothing",  "true or false", "a whole number",     "a number",
                                          "a vector", "a rotation",    "a symmetric matrix", "a text",
                                          "numbers",  "whole numbers", "named entries",      "an object of its plugin"};
    return words[static_cast<int>(type)];
}

/// Each number of a value; of a matrix the diagonal, to which bounds refer.
std::vector<double> bounded_numbers(const Value& value)
{
    if (const auto* n = std::get_if<std::int64_t>(&value)) return {static_cast<double>(*n)};
    if (const auto* x = std::get_if<double>(&value)) return {*x};
    if (const auto* v = std::get_if<Vec3>(&value)) return {v->x, v->y, v->z};
    if (const auto* a = std::get_if<Mat3>(&value)) return {(*a)(0, 0), (*a)(1, 1), (*a)(2, 2)};
    if (const auto* list = std::get_if<Reals>(&value)) return *list;
    if (const auto* list = std::get_if<Integers>(&value))
    {
        std::vector<double> out;
        for (const std::int64_t n : *list) out.push_back(static_cast<double>(n));
        return out;
    }
    return {};
}

std::vector<double> all_numbers(const Value& value)
{
    if (const auto* q = std::get_if<Quat>(&value)) return {q->w, q->x, q->y, q->z};
    if (const auto* entries = std::get_if<Entries>(&value))
    {
        std::vector<double> out;
        for (const Entry& e : *entries)
            if (const auto* x = std::get_if<double>(&e.value)) out.push_back(*x);
        return out;
    }
    std::vector<double> out = bounded_numbers(value);
    if (const auto* a = std::get_if<Mat3>(&value))
        for (const auto& [r, c] : {std::pair{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}}) out.push_back((*a)(r, c));
    return out;
}

/// Types for which only the ratios of the numbers count.
bool is_direction(const Field& field)
{
    return std::any_of(field.rules.begin(), field.rules.end(), [](const Rule& r) { return r.kind == Rule::Kind::UnitLength; });
}

Result<void> check_finite(const Value& value, const Field& field)
{
    const bool whole = std::holds_alternative<std::int64_t>(value) || std::holds_alternative<Integers>(value);
    for (const double x : all_numbers(value))
    {
        if (std::isnan(x)) return reason(subject_of(field) + " must be a number, not nan");
        if (std::isinf(x) && !field.may_be_infinite) return reason(subject_of(field) + " must be finite, not " + format_real(x));
        const bool measured = field.type != FieldType::Rotation && field.type != FieldType::EntryList && !is_direction(field);
        if (!whole && measured && std::isfinite(x) && std::fabs(x) > kLargestGiven)
            return reason(subject_of(field) + " must be at most " + format_real(kLargestGiven) + " in size, not " + format_real(x) +
                          ": its square would overflow");
    }
    if (const auto* v = std::get_if<Vec3>(&value))
        if (const int n = std::isinf(v->x) + std::isinf(v->y) + std::isinf(v->z); n == 1 || n == 2)
            return reason(subject_of(field) + " must have three finite numbers, or three infinite ones for 'not given'");
    return {};
}

Error broken(const Field& field, const std::string& rule, double has)
{
    return reason(subject_of(field) + " must be " + rule + ", not " + format_real(has));
}

Result<void> check_bound(const Value& value, const Field& field, const Rule& rule)
{
    for (const double x : bounded_numbers(value))
    {
        if (rule.kind == Rule::Kind::AtLeast && !(x >= rule.bound))
            return broken(field, rule.bound == 0 ? "0 or more" : "at least " + format_real(rule.bound), x);
        if (rule.kind == Rule::Kind::MoreThan && !(x > rule.bound))
            return broken(field, rule.bound == 0 ? "positive" : "more than " + format_real(rule.bound), x);
        if (rule.kind == Rule::Kind::MoreThan && rule.bound == 0 && x < kLeastGiven)
            return broken(field, "at least " + format_real(kLeastGiven), x);
        if (rule.kind == Rule::Kind::AtMost && !(x <= rule.bound)) return broken(field, "at most " + format_real(rule.bound), x);
    }
    return {};
}

/// Scales numbers to length 1; false if all are zero. Divides by the largest first, because squares of 1e-200 underflow to
/// zero.
bool normalise(std::span<double> v)
{
    double sum = 0;
    for (const double x : v) sum += x * x;
    if (std::fabs(sum - 1) <= kUnitTolerance) return true;
    double largest = 0;
    for (const double x : v) largest = std::max(largest, std::fabs(x));
    if (!(largest > 0)) return false;
    double scaled = 0;
    for (double& x : v)
    {
        x /= largest;
        scaled += x * x;
    }
    const double length = std::sqrt(scaled);
    for (double& x : v) x /= length;
    return true;
}

bool normalise(Vec3& v)
{
    double n[] = {v.x, v.y, v.z};
    const bool ok = normalise(n);
    if (ok) v = {n[0], n[1], n[2]};
    return ok;
}

Result<void> check_nonzero(Value& value, const Field& field, const Rule& rule)
{
    auto* v = std::get_if<Vec3>(&value);
    if (rule.kind == Rule::Kind::UnitLength && v)
    {
        if (!normalise(*v)) return reason(subject_of(field) + " must not be zero: it is a direction");
        return {};
    }
    const std::vector<double> n = bounded_numbers(value);
    if (v ? (v->x == 0 && v->y == 0 && v->z == 0) : std::any_of(n.begin(), n.end(), [](double x) { return x == 0; }))
        return reason(subject_of(field) + " must not be zero");
    return {};
}

Result<void> check_option(const Value& value, const Field& field, const Rule& rule)
{
    const auto* text = std::get_if<std::string>(&value);
    if (!text || std::find(rule.options.begin(), rule.options.end(), *text) != rule.options.end()) return {};
    return reason(subject_of(field) + " must be " + quoted_list(rule.options, "or") + ", not " + quoted(*text) +
                  did_you_mean(*text, rule.options));
}

Result<void> check_rule(Value& value, const Field& field, const Rule& rule)
{
    switch (rule.kind)
    {
        case Rule::Kind::AtLeast:
        case Rule::Kind::MoreThan:
        case Rule::Kind::AtMost:
            return check_bound(value, field, rule);
        case Rule::Kind::NonZero:
        case Rule::Kind::UnitLength:
            return check_nonzero(value, field, rule);
        case Rule::Kind::OneOf:
            break;
    }
    return check_option(value, field, rule);
}

/// Checks that each type makes independently of its rules.
Result<void> check_shape(Value& value, const Field& field)
{
    if (auto* q = std::get_if<Quat>(&value))
    {
        double n[] = {q->w, q->x, q->y, q->z};
        if (!normalise(n)) return reason(subject_of(field) + " must not be the zero quaternion");
        *q = {n[0], n[1], n[2], n[3]};
    }
    if (const auto* a = std::get_if<Mat3>(&value); a && *a != transposed(*a)) return reason(subject_of(field) + " must be symmetric");
    if (const auto* entries = std::get_if<Entries>(&value))
    {
        std::set<std::string> names;
        for (const Entry& e : *entries)
        {
            if (e.name.empty()) return reason(subject_of(field) + " has an entry without name");
            if (!names.insert(e.name).second) return reason(subject_of(field) + " has two entries named " + quoted(e.name));
        }
    }
    return {};
}

}  // namespace

Result<void> check_value(Value& value, const Field& field)
{
    // Whole numbers are accepted as numbers where they are exact.
    constexpr std::int64_t kExact = std::int64_t{1} << 53;
    const auto* whole = std::get_if<std::int64_t>(&value);
    if (whole && field.type == FieldType::Real && *whole >= -kExact && *whole <= kExact) value = static_cast<double>(*whole);
    if (type_of(value) != field.type)
        return reason(subject_of(field) + " must be " + std::string(type_words(field.type)) + ", not " +
                      std::string(type_words(type_of(value))));
    if (Result<void> r = check_finite(value, field); !r) return r;
    if (Result<void> r = check_shape(value, field); !r) return r;
    for (const Rule& rule : field.rules)
        if (Result<void> r = check_rule(value, field, rule); !r) return r;
    return {};
}

}  // namespace plab::model
