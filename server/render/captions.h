/// Lines of text over a picture, painted into its bytes.
#pragma once

#include <string>
#include <vector>

#include "font.h"
#include "render/render.h"

namespace plab::render
{

/// Dark letters with a light seam, readable on any ground; their size follows the picture's height.
class CaptionPainter
{
public:
    explicit CaptionPainter(std::uint32_t picture_height);
    /// Lines stand in their order, in a block at the top left and one at the bottom left. What is too long for the
    /// picture ends in dots; what is too much for its height is cut off.
    void paint(const std::vector<Caption>& captions, Picture& picture) const;

private:
    void paint_line(const std::string& text, int left, int baseline, Picture& picture) const;

    Font font_;
    int margin_, line_;  ///< pixels
};

}  // namespace plab::render
