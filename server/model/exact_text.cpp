#include "model/exact_text.h"

#include <cinttypes>
#include <cmath>
#include <cstdio>

namespace plab::model
{

std::string exact_text(double value, std::string_view otherwise)
{
    if (!std::isfinite(value)) return std::string(otherwise);
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

std::string hash_text(std::uint64_t hash)
{
    char text[20];
    std::snprintf(text, sizeof text, "%016" PRIx64, hash);
    return text;
}

}  // namespace plab::model
