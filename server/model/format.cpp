/// Values to text that reads back to the same bits.

#include <cmath>

#include "model/entries.h"
#include "model/numbers.h"
#include "model/values.h"

namespace plab::model
{

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

}  // namespace plab::model
