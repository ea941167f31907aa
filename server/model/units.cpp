#include "model/units.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "model/names.h"
#include "model/text.h"

namespace plab::model
{

namespace
{

struct Symbol
{
    std::string_view name;
    double numerator, denominator;
    int pi_power;
    Dimension dimension;  // metre, kilogram, second, radian
};

// The first unit of a dimension is the one without a factor, if there is one.
constexpr Symbol kSymbols[] = {
    {"m", 1, 1, 0, {{1, 0, 0, 0}}},        {"cm", 1, 100, 0, {{1, 0, 0, 0}}},    {"mm", 1, 1000, 0, {{1, 0, 0, 0}}},
    {"km", 1000, 1, 0, {{1, 0, 0, 0}}},    {"um", 1, 1e6, 0, {{1, 0, 0, 0}}},    {"kg", 1, 1, 0, {{0, 1, 0, 0}}},
    {"g", 1, 1000, 0, {{0, 1, 0, 0}}},     {"mg", 1, 1e6, 0, {{0, 1, 0, 0}}},    {"t", 1000, 1, 0, {{0, 1, 0, 0}}},
    {"s", 1, 1, 0, {{0, 0, 1, 0}}},        {"ms", 1, 1000, 0, {{0, 0, 1, 0}}},   {"us", 1, 1e6, 0, {{0, 0, 1, 0}}},
    {"min", 60, 1, 0, {{0, 0, 1, 0}}},     {"h", 3600, 1, 0, {{0, 0, 1, 0}}},    {"rad", 1, 1, 0, {{0, 0, 0, 1}}},
    {"deg", 1, 180, 1, {{0, 0, 0, 1}}},    {"rev", 2, 1, 1, {{0, 0, 0, 1}}},     {"turn", 2, 1, 1, {{0, 0, 0, 1}}},
    {"mrad", 1, 1000, 0, {{0, 0, 0, 1}}},  {"Hz", 1, 1, 0, {{0, 0, -1, 0}}},     {"kHz", 1000, 1, 0, {{0, 0, -1, 0}}},
    {"rpm", 1, 30, 1, {{0, 0, -1, 1}}},    {"N", 1, 1, 0, {{1, 1, -2, 0}}},      {"kN", 1000, 1, 0, {{1, 1, -2, 0}}},
    {"mN", 1, 1000, 0, {{1, 1, -2, 0}}},   {"J", 1, 1, 0, {{2, 1, -2, 0}}},      {"kJ", 1000, 1, 0, {{2, 1, -2, 0}}},
    {"W", 1, 1, 0, {{2, 1, -3, 0}}},       {"kW", 1000, 1, 0, {{2, 1, -3, 0}}},  {"Pa", 1, 1, 0, {{-1, 1, -2, 0}}},
    {"kPa", 1000, 1, 0, {{-1, 1, -2, 0}}}, {"MPa", 1e6, 1, 0, {{-1, 1, -2, 0}}},
};

const Symbol* find_symbol(std::string_view name)
{
    for (const Symbol& s : kSymbols)
        if (s.name == name) return &s;
    return nullptr;
}

Error unknown_unit(std::string_view name)
{
    std::vector<std::string> known;
    for (const Symbol& s : kSymbols) known.emplace_back(s.name);
    return reason("unknown unit " + quoted(name) + did_you_mean(name, known));
}

/// Exponents and factors this large are typing errors; the limit also keeps the sums below from overflowing.
constexpr int kMostPower = 12;

void reduce(UnitFactor& f)
{
    double a = f.numerator, b = f.denominator;
    while (b > 0)
    {
        const double r = std::fmod(a, b);
        a = b;
        b = r;
    }
    f.numerator /= a;
    f.denominator /= a;
}

/// Multiplies by symbol^power; false if the result exceeds the limits.
bool multiply(UnitFactor& f, const Symbol& symbol, int power)
{
    for (std::size_t i = 0; i < f.dimension.power.size(); ++i)
    {
        const int sum = f.dimension.power[i] + symbol.dimension.power[i] * power;
        if (std::abs(sum) > kMostPower) return false;
        f.dimension.power[i] = static_cast<signed char>(sum);
    }
    f.pi_power += symbol.pi_power * power;
    for (int i = 0; i < std::abs(power); ++i)
    {
        f.numerator *= power > 0 ? symbol.numerator : symbol.denominator;
        f.denominator *= power > 0 ? symbol.denominator : symbol.numerator;
        reduce(f);
    }
    return true;
}

/// Reads a unit from left to right.
class UnitReader
{
public:
    explicit UnitReader(std::string_view text) : text_(text) {}

    Result<UnitFactor> read()
    {
        UnitFactor out;
        // "1/s": a quotient without a numerator.
        if (text_.starts_with("1") && trimmed(text_.substr(1)).starts_with("/")) at_ = 1;
        bool first = at_ == 0;
        while (skip_blanks(), at_ < text_.size())
        {
            int sign = 1;
            if (!first && (text_[at_] == '/' || text_[at_] == '*'))
            {
                sign = text_[at_++] == '/' ? -1 : 1;
                skip_blanks();
            }
            first = false;
            if (auto r = read_factor(out, sign); !r) return r.errors();
        }
        return out;
    }

private:
    void skip_blanks()
    {
        while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    }

    Result<void> read_factor(UnitFactor& out, int sign)
    {
        const std::size_t begin = at_;
        while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '/' && text_[at_] != '*' && text_[at_] != '^') ++at_;
        const std::string_view name = text_.substr(begin, at_ - begin);
        if (name.empty() || !is_letter(name.front())) return reason(quoted(text_) + " is not a unit");
        const Symbol* symbol = find_symbol(name);
        if (!symbol) return unknown_unit(name);
        int power = 1;
        if (at_ < text_.size() && text_[at_] == '^')
        {
            const char* const from = text_.data() + at_ + 1;
            const auto [end, ec] = std::from_chars(from, text_.data() + text_.size(), power);
            if (ec != std::errc() || std::abs(power) > kMostPower || power == 0)
                return reason(quoted(text_) + " has an exponent that is not a small whole number");
            at_ = static_cast<std::size_t>(end - text_.data());
            if (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '/' && text_[at_] != '*')
                return reason(quoted(text_) + " is not a unit");
        }
        if (!multiply(out, *symbol, sign * power)) return reason(quoted(text_) + " is not a sensible unit");
        return {};
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace

double UnitFactor::to_si(double value) const
{
    double out = value * numerator / denominator;
    for (int i = 0; i < pi_power; ++i) out *= std::numbers::pi;
    for (int i = 0; i > pi_power; --i) out /= std::numbers::pi;
    return out;
}

Result<UnitFactor> parse_unit(std::string_view text) { return UnitReader(trimmed(text)).read(); }

bool unit_fits(const Dimension& written, const Dimension& declared)
{
    if (written == declared) return true;
    const bool rest_agrees =
        written.power[0] == declared.power[0] && written.power[1] == declared.power[1] && written.power[2] == declared.power[2];
    // Only if mass is involved: "2 Hz" for rad/s would hide whether turns or radians are meant.
    return rest_agrees && written.power[3] == 0 && declared.power[1] != 0;
}

std::string describe_unit(const Unit& unit)
{
    std::string others;
    for (const Symbol& s : kSymbols)
        if (s.dimension == unit.dimension && s.name != unit.symbol) others += (others.empty() ? "" : ", ") + std::string(s.name);
    return std::string(unit.symbol) + (others.empty() ? "" : " (or " + others + ")");
}

bool is_unit_symbol(std::string_view text) { return find_symbol(text) != nullptr; }

}  // namespace plab::model
