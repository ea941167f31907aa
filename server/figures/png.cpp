// Renders the same list of shapes with cairo.
#include <cairo/cairo.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "figures/drawing.h"

namespace plab::figures
{
namespace
{

struct Destroy
{
    void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
    void operator()(cairo_t* c) const { cairo_destroy(c); }
};

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
    cairo_select_font_face(c, "sans-serif", CAIRO_FONT_SLANT_NORMAL, how.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(c, how.size);
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

}  // namespace

Result<void> Drawing::write_png(const std::string& path, double scale) const
{
    const std::unique_ptr<cairo_surface_t, Destroy> surface(cairo_image_surface_create(
        CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(width_ * scale)), static_cast<int>(std::lround(height_ * scale))));
    const std::unique_ptr<cairo_t, Destroy> context(cairo_create(surface.get()));
    cairo_t* c = context.get();
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
    if (cairo_surface_write_to_png(surface.get(), path.c_str()) != CAIRO_STATUS_SUCCESS) return reason("cannot write " + path);
    return {};
}

}  // namespace plab::figures
