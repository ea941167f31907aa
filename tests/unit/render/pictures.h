/// Small pictures for tests, and single pixels of them.
#pragma once

#include <doctest/doctest.h>

#include <array>

#include "render/render.h"

namespace plab::test
{

constexpr std::uint32_t kWidth = 160, kHeight = 120;

inline render::Picture drawn(const render::Drawing& drawing)
{
    static const std::unique_ptr<render::Renderer> renderer = []
    {
        auto made = render::make_renderer(kWidth, kHeight);
        REQUIRE_MESSAGE(made.ok(), (made ? std::string() : made.error().text()));
        return made.take();
    }();
    render::Picture out;
    const auto done = renderer->draw(drawing, out);
    REQUIRE_MESSAGE(done.ok(), (done ? std::string() : done.error().text()));
    REQUIRE(out.rgba.size() == 4 * kWidth * kHeight);
    return out;
}

struct Pixel
{
    int red, green, blue, alpha;
    int brightness() const { return red + green + blue; }
    friend bool operator==(const Pixel&, const Pixel&) = default;
};

inline Pixel pixel(const render::Picture& picture, std::uint32_t x, std::uint32_t y)
{
    const std::uint8_t* p = picture.rgba.data() + 4 * (std::size_t{y} * picture.width + x);
    return {p[0], p[1], p[2], p[3]};
}

inline Pixel middle(const render::Picture& picture) { return pixel(picture, picture.width / 2, picture.height / 2); }

/// The background alone: from 5 m along -y, z is up.
inline render::Drawing empty_drawing()
{
    render::Drawing out;
    out.view = {{0, -5, 0}, {0, 0, 0}, {0, 0, 1}, 0.7};
    out.ground = false;
    return out;
}

inline render::Item item(render::Form form, const Vec3& position, const Vec3& size, const Vec3& color)
{
    render::Item out;
    out.form = form, out.pose.p = position, out.size = size, out.color = color;
    return out;
}

inline constexpr Vec3 kRed{0.9, 0.05, 0.05}, kGreen{0.05, 0.8, 0.05};

}  // namespace plab::test
