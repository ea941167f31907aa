/// Cells of CSV (RFC 4180, lines end with a line feed). Numbers have as many digits as it takes to read the same value back.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "idl/plab.h"

namespace plab::recordings
{

class CsvRow
{
public:
    CsvRow& text(std::string_view value);
    CsvRow& real(double value);
    template <class T>
    requires std::is_integral_v<T> CsvRow& whole(T value) { return put(std::to_string(value)); }
    CsvRow& none() { return put(""); }
    CsvRow& none(int cells);
    CsvRow& vector(const plab_v2_Vector& value);
    CsvRow& rotation(const plab_v2_Rotation& value);
    /// Nanoseconds as seconds, all nine digits.
    CsvRow& seconds(std::uint64_t nanoseconds);
    /// 16 hexadecimal digits.
    CsvRow& hexadecimal(std::uint64_t value);
    void end();

    /// All rows since the last call.
    std::string take() { return std::exchange(text_, {}); }

private:
    CsvRow& put(std::string_view ready);

    std::string text_;
    bool is_first_ = true;
};

}  // namespace plab::recordings
