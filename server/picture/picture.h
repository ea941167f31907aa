/// Pixels and the file that they are written to.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plab/result.h"

namespace plab::picture
{

/// 8 bits per channel, red green blue alpha, rows from the top.
struct Picture
{
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

/// Writes to a temporary file and renames it, so that readers always see a complete picture.
Result<void> write_png(const std::string& path, const Picture& picture);

}  // namespace plab::picture
