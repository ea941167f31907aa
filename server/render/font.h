/// The letters of captions, each drawn once.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace plab::render
{

/// A letter in pixels: the coverage of each pixel by the ink, and by the outline around it.
struct Glyph
{
    int left = 0, top = 0;  ///< of the first pixel, relative to the pen on the base line; top counts upwards
    int width = 0, height = 0;
    int advance = 0;                      ///< to the next letter
    std::vector<std::uint8_t> ink, seam;  ///< 0 to 255, rows from the top
};

class Font
{
public:
    /// `capital`: height of capitals, in pixels.
    explicit Font(double capital);
    /// `letter` is one character in UTF-8. The glyph stays where it is.
    const Glyph& glyph(std::string_view letter);

private:
    double size_, seam_;  ///< of the typeface and of the outline, pixels
    std::unordered_map<std::string, Glyph> glyphs_;
};

/// Removes the first letter from UTF-8 text and returns it; for a byte that belongs to no letter, the replacement character.
std::string_view next_letter(std::string_view& text);

}  // namespace plab::render
