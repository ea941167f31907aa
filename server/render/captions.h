/// Lines of text over a picture, drawn into its pixels.
#pragma once

#include <string>
#include <vector>

#include "font.h"
#include "render/render.h"

namespace plab::render
{

/// Dark letters with a light outline, readable on any background; their size follows the picture's height.
class CaptionPainter
{
public:
    explicit CaptionPainter(std::uint32_t picture_height);
    /// Lines are in their order, in a block at the top left and one at the bottom left. A line that is too long for the picture
    /// ends in dots; lines that exceed its height are left out.
    void paint(const std::vector<Caption>& captions, Picture& picture);

private:
    void paint_line(const std::string& text, int left, int baseline, Picture& picture);

    Font font_;
    int margin_, line_;  ///< pixels
};

}  // namespace plab::render
