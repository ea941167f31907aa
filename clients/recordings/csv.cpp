#include "recordings/csv.h"

#include <array>
#include <cinttypes>
#include <cstdio>

#include "link/json_text.h"

namespace plab::recordings
{
namespace
{

constexpr std::uint64_t kPerSecond = 1'000'000'000;

}  // namespace

CsvRow& CsvRow::put(std::string_view ready)
{
    if (!is_first_) text_ += ',';
    text_ += ready;
    is_first_ = false;
    return *this;
}

CsvRow& CsvRow::text(std::string_view value)
{
    if (value.find_first_of(",\"\r\n") == std::string_view::npos) return put(value);
    std::string quoted = "\"";
    for (const char c : value) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return put(quoted + "\"");
}

CsvRow& CsvRow::real(double value) { return put(link::number_text(value)); }

CsvRow& CsvRow::none(int cells)
{
    for (int i = 0; i < cells; ++i) (void)none();
    return *this;
}

CsvRow& CsvRow::vector(const plab_v2_Vector& value) { return real(value.x).real(value.y).real(value.z); }

CsvRow& CsvRow::rotation(const plab_v2_Rotation& value) { return real(value.w).real(value.x).real(value.y).real(value.z); }

CsvRow& CsvRow::seconds(std::uint64_t nanoseconds)
{
    std::array<char, 40> digits{};
    std::snprintf(digits.data(), digits.size(), "%" PRIu64 ".%09" PRIu64, nanoseconds / kPerSecond, nanoseconds % kPerSecond);
    return put(digits.data());
}

CsvRow& CsvRow::hexadecimal(std::uint64_t value)
{
    std::array<char, 24> digits{};
    std::snprintf(digits.data(), digits.size(), "%016" PRIx64, value);
    return put(digits.data());
}

void CsvRow::end()
{
    text_ += '\n';
    is_first_ = true;
}

}  // namespace plab::recordings
