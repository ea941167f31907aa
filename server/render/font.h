/// Letters as strokes, designed for this program: no font file is needed.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
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
    /// Characters other than ASCII are shown as a box.
    const Glyph& glyph(char32_t letter) const;

private:
    static constexpr char32_t kFirst = 32, kLast = 126;
    std::array<Glyph, kLast - kFirst + 2> glyphs_;  ///< the last one is the box
};

/// Removes the first letter from UTF-8 text and returns it; an invalid byte counts as a letter of its own.
char32_t next_letter(std::string_view& text);

}  // namespace plab::render
