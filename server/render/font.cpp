#include "font.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "picture/lettering.h"

namespace plab::render
{
namespace
{

constexpr double kLeastSeam = 1.3, kSeam = 0.16;  ///< width of the outline: pixels, and relative to the height of capitals
constexpr std::string_view kReplacement = "\xef\xbf\xbd";

/// Canvas whose pixels are coverage alone.
picture::Canvas make_canvas(int width, int height, double size)
{
    const picture::Surface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, width, height));
    picture::Canvas out(cairo_create(surface.get()));
    picture::select_letters(out.get(), size);
    return out;
}

/// Typefaces differ in how high capitals are for their size; a typeface without letters counts as any other.
double size_for(double capital)
{
    constexpr double kTried = 100;
    const picture::Canvas canvas = make_canvas(1, 1, kTried);
    cairo_text_extents_t extents{};
    cairo_text_extents(canvas.get(), "H", &extents);
    return extents.height > 0 ? capital * kTried / extents.height : capital / 0.7;
}

std::vector<std::uint8_t> coverage_of(cairo_t* canvas, const Glyph& glyph)
{
    cairo_surface_t* surface = cairo_get_target(canvas);
    cairo_surface_flush(surface);
    std::vector<std::uint8_t> out;
    const unsigned char* row = cairo_image_surface_get_data(surface);
    for (int y = 0; y < glyph.height; ++y, row += cairo_image_surface_get_stride(surface)) out.insert(out.end(), row, row + glyph.width);
    return out;
}

/// Nothing if cairo refuses the text.
Glyph drawn(const std::string& letter, double size, double seam)
{
    cairo_text_extents_t extents{};
    cairo_text_extents(make_canvas(1, 1, size).get(), letter.c_str(), &extents);
    Glyph out;
    out.advance = static_cast<int>(std::lround(extents.x_advance));
    if (!(extents.width > 0 && extents.height > 0)) return out;
    const double around = seam + 1;
    out.left = static_cast<int>(std::floor(extents.x_bearing - around)), out.top = static_cast<int>(std::ceil(around - extents.y_bearing));
    out.width = static_cast<int>(std::ceil(extents.x_bearing + extents.width + around)) - out.left;
    out.height = out.top + static_cast<int>(std::ceil(extents.y_bearing + extents.height + around));

    const picture::Canvas ink = make_canvas(out.width, out.height, size), outline = make_canvas(out.width, out.height, size);
    for (cairo_t* canvas : {ink.get(), outline.get()}) cairo_move_to(canvas, -out.left, out.top);
    cairo_show_text(ink.get(), letter.c_str());
    out.ink = coverage_of(ink.get(), out);

    cairo_text_path(outline.get(), letter.c_str());
    cairo_fill_preserve(outline.get());
    cairo_set_line_width(outline.get(), 2 * seam);
    cairo_set_line_join(outline.get(), CAIRO_LINE_JOIN_ROUND);
    cairo_stroke(outline.get());
    out.seam = coverage_of(outline.get(), out);
    return out;
}

}  // namespace

Font::Font(double capital) : size_(size_for(capital)), seam_(std::max(kLeastSeam, kSeam * capital)) {}

const Glyph& Font::glyph(std::string_view letter)
{
    const auto [at, fresh] = glyphs_.try_emplace(std::string(letter));
    if (fresh) at->second = drawn(at->first, size_, seam_);
    return at->second;
}

std::string_view next_letter(std::string_view& text)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc0 ? 2 : 1;
    bool whole = lead < 0x80 || (lead >= 0xc0 && length <= text.size());
    for (std::size_t i = 1; whole && i < length; ++i) whole = (byte(i) & 0xc0) == 0x80;
    const std::string_view out = whole ? text.substr(0, length) : kReplacement;
    text.remove_prefix(whole ? length : 1);
    return out;
}

}  // namespace plab::render
