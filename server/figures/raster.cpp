// Renders the same list of shapes with cairo.
#include <cmath>
#include <cstring>
#include <numbers>

#include "figures/drawing.h"
#include "picture/lettering.h"
#include "picture/picture.h"

namespace plab::figures
{
namespace
{

void use(cairo_t* c, const Ink& ink)
{
    const Rgb rgb = light_color(ink);
    cairo_set_source_rgb(c, rgb.r, rgb.g, rgb.b);
}

void trace(cairo_t* c, const std::vector<Spot>& points, bool closed)
{
    cairo_new_path(c);
    for (const Spot& p : points) cairo_line_to(c, p.x, p.y);
    if (closed) cairo_close_path(c);
}

void stroke(cairo_t* c, const Pen& pen)
{
    const double dashes[] = {5, 4};
    cairo_set_dash(c, dashes, pen.dashed ? 2 : 0, 0);
    cairo_set_line_width(c, pen.width);
    use(c, pen.ink);
    cairo_stroke(c);
}

void write_words(cairo_t* c, const Spot& at, const std::string& text, const Words& how)
{
    picture::select_letters(c, how.size, how.bold);
    cairo_text_extents_t extents;
    cairo_text_extents(c, text.c_str(), &extents);
    const double shift = how.anchor == Anchor::Start ? 0 : how.anchor == Anchor::Middle ? -0.5 * extents.x_advance : -extents.x_advance;
    cairo_save(c);
    cairo_translate(c, at.x, at.y);
    if (how.upright) cairo_rotate(c, -std::numbers::pi / 2);
    cairo_move_to(c, shift, 0);
    use(c, how.ink);
    cairo_show_text(c, text.c_str());
    cairo_restore(c);
}

/// Cairo keeps a pixel as one number of 32 bits, 0xXXRRGGBB, in the machine's byte order.
picture::Picture pixels_of(cairo_surface_t* surface)
{
    cairo_surface_flush(surface);
    picture::Picture out;
    out.width = static_cast<std::uint32_t>(cairo_image_surface_get_width(surface));
    out.height = static_cast<std::uint32_t>(cairo_image_surface_get_height(surface));
    out.rgba.reserve(std::size_t{4} * out.width * out.height);
    const unsigned char* row = cairo_image_surface_get_data(surface);
    for (std::uint32_t y = 0; y < out.height; ++y, row += cairo_image_surface_get_stride(surface))
        for (std::uint32_t x = 0; x < out.width; ++x)
        {
            std::uint32_t rgb = 0;
            std::memcpy(&rgb, row + std::size_t{4} * x, 4);
            for (const int shift : {16, 8, 0}) out.rgba.push_back(static_cast<std::uint8_t>(rgb >> shift));
            out.rgba.push_back(255);
        }
    return out;
}

}  // namespace

Result<void> Drawing::write_png(const std::string& path, double scale) const
{
    const picture::Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(width_ * scale)),
                                                              static_cast<int>(std::lround(height_ * scale))));
    const picture::Canvas canvas(cairo_create(surface.get()));
    cairo_t* c = canvas.get();
    cairo_set_source_rgb(c, 1, 1, 1);
    cairo_paint(c);
    cairo_scale(c, scale, scale);
    cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
    for (const Item& item : items_)
    {
        if (item.kind == Kind::Words)
        {
            write_words(c, item.points[0], item.text, item.how);
            continue;
        }
        if (item.kind == Kind::Dot)
            cairo_new_path(c), cairo_arc(c, item.points[0].x, item.points[0].y, item.radius, 0, 2 * std::numbers::pi);
        else
            trace(c, item.points, item.kind == Kind::Area);
        if (item.kind == Kind::Line)
        {
            stroke(c, item.pen);
            continue;
        }
        use(c, item.fill);
        cairo_fill_preserve(c);
        if (item.pen.ink.role != Ink::Role::Text)
            stroke(c, item.pen);
        else
            cairo_new_path(c);
    }
    if (const cairo_status_t status = cairo_status(c); status != CAIRO_STATUS_SUCCESS)
        return reason("cannot draw " + path + ": " + cairo_status_to_string(status));
    return picture::write_png(path, pixels_of(surface.get()));
}

}  // namespace plab::figures
