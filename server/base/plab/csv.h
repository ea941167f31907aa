/// Lines of CSV (RFC 4180, lines end with a line feed). The only place that puts cells together.
#pragma once

#include <cinttypes>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "plab/number_text.h"

namespace plab
{

class CsvRow
{
public:
    /// In quotes where it has to be.
    CsvRow& text(std::string_view value)
    {
        if (value.find_first_of(",\"\r\n") == std::string_view::npos) return put(value);
        std::string quoted = "\"";
        for (const char c : value) quoted += c == '"' ? "\"\"" : std::string(1, c);
        return put(quoted + "\"");
    }
    /// As few digits as it takes to read the same value back.
    CsvRow& real(double value) { return put(number_text(value)); }
    /// 17 significant digits; empty if the value is not finite.
    CsvRow& exact(double value) { return std::isfinite(value) ? print("%.17g", value) : none(); }
    template <class T>
    requires std::is_integral_v<T> CsvRow& whole(T value) { return put(std::to_string(value)); }
    CsvRow& none(int cells = 1)
    {
        for (int i = 0; i < cells; ++i) (void)put("");
        return *this;
    }
    /// x, y, z
    template <class Vector>
    CsvRow& vector(const Vector& v)
    {
        return real(v.x).real(v.y).real(v.z);
    }
    /// w, x, y, z
    template <class Rotation>
    CsvRow& rotation(const Rotation& q)
    {
        return real(q.w).real(q.x).real(q.y).real(q.z);
    }
    /// Nanoseconds as seconds, all nine digits.
    CsvRow& seconds(std::uint64_t nanoseconds)
    {
        constexpr std::uint64_t kPerSecond = 1'000'000'000;
        return print("%" PRIu64 ".%09" PRIu64, nanoseconds / kPerSecond, nanoseconds % kPerSecond);
    }
    /// 16 hexadecimal digits.
    CsvRow& hexadecimal(std::uint64_t value) { return print("%016" PRIx64, value); }
    /// Cells that are ready, such as a part of a first line.
    CsvRow& put(std::string_view ready)
    {
        if (!is_first_) text_ += ',';
        text_ += ready;
        is_first_ = false;
        return *this;
    }
    void end()
    {
        text_ += '\n';
        is_first_ = true;
    }

    /// All rows since the last call.
    std::string take() { return std::exchange(text_, {}); }

private:
    template <class... Values>
    CsvRow& print(const char* format, Values... values)
    {
        char digits[48];
        const int n = std::snprintf(digits, sizeof digits, format, values...);
        return put(std::string_view(digits, static_cast<std::size_t>(n)));
    }

    std::string text_;
    bool is_first_ = true;
};

}  // namespace plab
