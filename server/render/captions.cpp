#include "captions.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace plab::render
{
namespace
{

using Color = std::array<int, 3>;
constexpr Color kInk{12, 20, 30}, kSeamColor{250, 251, 252};
constexpr int kSeamStrength = 190;  ///< of 255

void blend(std::uint8_t* pixel, const Color& color, int share)
{
    for (std::size_t k = 0; k < 3; ++k) pixel[k] = static_cast<std::uint8_t>((pixel[k] * (255 - share) + color[k] * share + 127) / 255);
}

/// Draws one of a glyph's two layers, as far as it is inside the picture.
void paint_layer(const Glyph& glyph, bool ink, int left, int baseline, Picture& picture)
{
    const std::vector<std::uint8_t>& layer = ink ? glyph.ink : glyph.seam;
    const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
    for (int y = 0; y < glyph.height; ++y)
        for (int x = 0; x < glyph.width; ++x)
        {
            const int column = left + glyph.left + x, row = baseline - glyph.top + y;
            const int share = layer[static_cast<std::size_t>(y * glyph.width + x)];
            if (share == 0 || column < 0 || column >= width || row < 0 || row >= height) continue;
            std::uint8_t* pixel =
                picture.rgba.data() + 4 * (static_cast<std::size_t>(row) * picture.width + static_cast<std::size_t>(column));
            blend(pixel, ink ? kInk : kSeamColor, ink ? share : share * kSeamStrength / 255);
        }
}

double capital_height(std::uint32_t picture_height) { return std::clamp(picture_height / 54.0, 7.0, 120.0); }

}  // namespace

CaptionPainter::CaptionPainter(std::uint32_t picture_height)
    : font_(capital_height(picture_height)),
      margin_(static_cast<int>(std::lround(1.4 * capital_height(picture_height)))),
      line_(static_cast<int>(std::lround(1.75 * capital_height(picture_height))))
{
}

void CaptionPainter::paint(const std::vector<Caption>& captions, Picture& picture)
{
    const auto below = std::count_if(captions.begin(), captions.end(), [](const Caption& c) { return c.bottom; });
    int top = margin_ + line_ / 2, bottom = static_cast<int>(picture.height) - margin_ - (static_cast<int>(below) - 1) * line_;
    for (const Caption& caption : captions)
    {
        int& baseline = caption.bottom ? bottom : top;
        paint_line(caption.text, margin_, baseline, picture);
        baseline += line_;
    }
}

void CaptionPainter::paint_line(const std::string& text, int left, int baseline, Picture& picture)
{
    struct Placed
    {
        const Glyph* glyph;
        int left;
    };
    const int dots = 3 * font_.glyph(".").advance, end = static_cast<int>(picture.width) - margin_;
    std::vector<Placed> line;
    int pen = left;
    for (std::string_view rest = text; !rest.empty();)
    {
        const Glyph& glyph = font_.glyph(next_letter(rest));
        line.push_back({&glyph, pen});
        pen += glyph.advance;
    }
    if (pen > end)
    {
        while (!line.empty() && pen + dots > end) pen = line.back().left, line.pop_back();
        for (int i = 0; i < 3; ++i, pen += dots / 3) line.push_back({&font_.glyph("."), pen});
    }
    // All outlines are below all letters.
    for (const bool ink : {false, true})
        for (const Placed& placed : line) paint_layer(*placed.glyph, ink, placed.left, baseline, picture);
}

}  // namespace plab::render
