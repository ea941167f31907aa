/// Cairo's handles, and how all pictures and diagrams write: DejaVu Sans, or what fontconfig has in its place.
#pragma once

#include <cairo/cairo.h>

#include <memory>

namespace plab::picture
{

struct CairoDestroy
{
    void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
    void operator()(cairo_t* c) const { cairo_destroy(c); }
};
using Surface = std::unique_ptr<cairo_surface_t, CairoDestroy>;
using Canvas = std::unique_ptr<cairo_t, CairoDestroy>;

/// Selects the typeface in this size. Antialiasing and hinting are fixed, so that a desktop's settings change no picture.
void select_letters(cairo_t* canvas, double size, bool bold = false);

}  // namespace plab::picture
