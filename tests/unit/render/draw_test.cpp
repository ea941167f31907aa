/// The content of pictures: shapes, depth, shadows, captions, and that a drawing always gives the same bytes.
#include <cmath>
#include <limits>
#include <numbers>

#include "pictures.h"

using namespace plab;
using namespace plab::render;
using namespace plab::test;

TEST_CASE("a red sphere is red in the middle, round, and the background is all around")
{
    for (const double radius : {0.3, 1.2})  // a quad with the ball shader, and triangles
    {
        CAPTURE(radius);
        Drawing drawing = empty_drawing();
        const Picture nothing = drawn(drawing);
        drawing.items = {item(Form::Sphere, {}, {radius, 0, 0}, kRed)};
        const Picture picture = drawn(drawing);
        const Pixel p = middle(picture);
        CHECK(p.red > 150);
        CHECK(p.red > 2 * p.green);
        CHECK(p.red > 2 * p.blue);
        for (const auto& [x, y] : {std::pair{2u, 2u}, {157u, 2u}, {2u, 117u}, {157u, 117u}})
            CHECK(pixel(picture, x, y) == pixel(nothing, x, y));
        // The outline: sin(angle) = radius / 5.
        const double outline = std::tan(std::asin(radius / 5)) * kHeight / (2 * std::tan(0.35));
        for (const double angle : {0.0, 0.8, 2.0, 3.1, 4.5})
        {
            const auto at = [&](double r)
            {
                const auto x = static_cast<std::uint32_t>(0.5 * kWidth + r * std::cos(angle));
                const auto y = static_cast<std::uint32_t>(0.5 * kHeight + r * std::sin(angle));
                return pixel(picture, x, y) == pixel(nothing, x, y);
            };
            CHECK_FALSE(at(outline - 2));
            CHECK(at(outline + 2));
        }
    }
}

TEST_CASE("up in the view is up in the picture, right is right")
{
    Drawing drawing = empty_drawing();
    const Picture nothing = drawn(drawing);
    drawing.items = {item(Form::Sphere, {0.8, 0, 0.6}, {0.3, 0, 0}, kRed)};
    const Picture picture = drawn(drawing);
    const auto empty = [&](std::uint32_t x, std::uint32_t y) { return pixel(picture, x, y) == pixel(nothing, x, y); };
    CHECK_FALSE(empty(106, 40));  // 32.9 pixels a metre: 80 + 26, 60 - 20
    CHECK(empty(106, 80));
    CHECK(empty(54, 40));
    CHECK(empty(54, 80));
}

TEST_CASE("the picture is opaque, whatever was blended into it")
{
    Drawing drawing = empty_drawing();
    drawing.ground = true;
    drawing.view.position.z = 2;
    drawing.items = {item(Form::Sphere, {0, 0, -0.2}, {0.5, 0, 0}, kRed)};
    const Picture picture = drawn(drawing);
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) REQUIRE(picture.rgba[i] == 255);
}

TEST_CASE("nearer objects hide farther ones, in either order")
{
    Drawing drawing = empty_drawing();
    for (const Form form : {Form::Sphere, Form::Box, Form::Cylinder})
    {
        drawing.items = {item(form, {0, -1, 0}, {0.3, 0.3, 0.3}, kRed), item(form, {0, 1, 0}, {0.6, 0.6, 0.6}, kGreen)};
        const Pixel first = middle(drawn(drawing));
        std::swap(drawing.items[0], drawing.items[1]);
        const Pixel second = middle(drawn(drawing));
        CHECK(first.red > 2 * first.green);
        CHECK(first == second);
    }
}

TEST_CASE("every shape is drawn in its pose and size")
{
    // Turned so that z, the long side, lies along x: from -1 to 1, seen from 5 m as 0.28 of the half height each 0.5 m.
    const Quat along_x{std::sqrt(0.5), 0, std::sqrt(0.5), 0};
    Drawing drawing = empty_drawing();
    const Picture nothing = drawn(drawing);
    Mesh rod;
    for (int i = 0; i < 8; ++i) rod.vertices.push_back({i & 1 ? 0.2 : -0.2, i & 2 ? 0.2 : -0.2, i & 4 ? 1.0 : -1.0});
    rod.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    drawing.meshes = {rod};
    drawing.meshes_revision = 7;
    for (const Form form : {Form::Box, Form::Cylinder, Form::Capsule, Form::Mesh})
    {
        CAPTURE(static_cast<int>(form));
        drawing.items = {item(form, {0.3, 0, 0}, {0.2, 0.2, form == Form::Capsule ? 0.8 : 1}, kGreen)};
        drawing.items[0].pose.q = along_x;
        const Picture picture = drawn(drawing);
        const auto differs = [&](double x, double z)
        {
            const double scale = kHeight / (2 * std::tan(0.35) * 5);
            const auto column = static_cast<std::uint32_t>(0.5 * kWidth + x * scale);
            const auto row = static_cast<std::uint32_t>(0.5 * kHeight - z * scale);
            return !(pixel(picture, column, row) == pixel(nothing, column, row));
        };
        for (const double x : {-0.6, 0.3, 1.2}) CHECK(differs(x, 0));
        for (const double x : {-0.85, 1.45}) CHECK_FALSE(differs(x, 0));
        for (const double z : {-0.35, 0.35}) CHECK_FALSE(differs(0.3, z));
    }
}

TEST_CASE("the ground is darker in the shadow of a body")
{
    Drawing drawing = empty_drawing();
    drawing.view = {{0.6, -4, 5}, {0.6, 0.8, 0}, {0, 0, 1}, 0.9};
    for (const bool plane : {false, true})
    {
        CAPTURE(plane);
        drawing.ground = !plane;
        drawing.items.clear();
        if (plane) drawing.items.push_back(item(Form::Plane, {}, {}, {0.8, 0.8, 0.8}));
        const Picture lit = drawn(drawing);
        drawing.items.push_back(item(Form::Sphere, {0, 0, 1.5}, {0.4, 0, 0}, kRed));
        const Picture shadowed = drawn(drawing);
        // The light comes from (-0.42, -0.55, 1.05): the shadow of a ball at 1.5 m lies at (0.6, 0.79), the view's middle.
        CHECK(middle(shadowed).brightness() < middle(lit).brightness() - 60);
        CHECK(pixel(shadowed, 10, 110) == pixel(lit, 10, 110));
    }
}

TEST_CASE("a body throws its shadow on another")
{
    Drawing drawing = empty_drawing();
    drawing.view = {{0, -3, 6}, {0, 0, 0}, {0, 0, 1}, 0.7};
    const Item table = item(Form::Box, {0, 0, -0.1}, {1.5, 1.5, 0.1}, {0.8, 0.8, 0.8});
    drawing.items = {table};
    const Pixel lit = middle(drawn(drawing));
    drawing.items.push_back(item(Form::Sphere, {-0.42 * 1.5, -0.55 * 1.5, 1.05 * 1.5}, {0.3, 0, 0}, kRed));
    CHECK(middle(drawn(drawing)).brightness() < lit.brightness() - 100);
}

TEST_CASE("objects below the ground shine through; a plane hides them")
{
    Drawing drawing = empty_drawing();
    drawing.view = {{0, -3, 3}, {0.3, 0.2, 0}, {0, 0, 1}, 0.7};
    drawing.ground = true;
    const Picture ground = drawn(drawing);
    const Item below = item(Form::Sphere, {0.4, 1.27, -1}, {0.6, 0, 0}, kRed);
    drawing.items = {below};
    const Pixel veiled = middle(drawn(drawing));
    CHECK(veiled.red > veiled.green + 10);
    CHECK_FALSE(veiled == middle(ground));
    drawing.items = {item(Form::Plane, {}, {}, {0.8, 0.8, 0.8})};
    const Pixel plane = middle(drawn(drawing));
    drawing.items.push_back(below);
    CHECK(middle(drawn(drawing)) == plane);
}

TEST_CASE("a caption changes pixels on its side only, and a long one ends before the margin")
{
    Drawing drawing = empty_drawing();
    const Picture plain = drawn(drawing);
    const auto changed = [&](const Picture& picture, std::uint32_t from, std::uint32_t to)
    {
        int out = 0;
        for (std::uint32_t y = from; y < to; ++y)
            for (std::uint32_t x = 0; x < kWidth; ++x) out += pixel(picture, x, y) == pixel(plain, x, y) ? 0 : 1;
        return out;
    };
    drawing.captions = {{"t = 1.5 s", false}};
    const Picture top = drawn(drawing);
    CHECK(changed(top, 0, 40) > 50);
    CHECK(changed(top, 40, kHeight) == 0);
    drawing.captions = {{"gears: Constraint/AngularVelocity/Graph, and so on, far beyond the picture", true}};
    const Picture bottom = drawn(drawing);
    CHECK(changed(bottom, 0, 80) == 0);
    CHECK(changed(bottom, 80, kHeight) > 200);
    for (std::uint32_t y = 0; y < kHeight; ++y) CHECK(pixel(bottom, kWidth - 3, y) == pixel(plain, kWidth - 3, y));
    drawing.captions = {{"\xff\xc3\xa4 \xe2\x82", false}, {"", false}};  // letters that the font lacks, and bytes that are not letters
    CHECK(changed(drawn(drawing), 0, 40) > 20);
}

TEST_CASE("two drawings of one scene are the same bytes, by one renderer and by another")
{
    Drawing drawing = empty_drawing();
    drawing.view = {{1, -5, 2}, {0, 0, 0.5}, {0, 0, 1}, 0.7};
    drawing.ground = true;
    for (int i = 0; i < 20; ++i) drawing.items.push_back(item(Form::Sphere, {0.3 * (i % 5), 0.3 * (i / 5), 0.4}, {0.12, 0, 0}, kGreen));
    drawing.items.push_back(item(Form::Box, {-0.5, 0, 0.5}, {0.2, 0.3, 0.5}, kRed));
    drawing.captions = {{"twice", false}};
    const Picture first = drawn(drawing);
    (void)drawn(empty_drawing());
    CHECK(drawn(drawing).rgba == first.rgba);
    auto other = make_renderer(kWidth, kHeight);
    REQUIRE(other.ok());
    Picture second;
    REQUIRE((*other)->draw(drawing, second).ok());
    CHECK(second.rgba == first.rgba);
}

TEST_CASE("far from the origin a picture is the same as near it")
{
    const auto at = [](const Vec3& origin)
    {
        Drawing drawing = empty_drawing();
        drawing.view.position += origin, drawing.view.look_at += origin;
        drawing.items = {item(Form::Sphere, origin, {0.5, 0, 0}, kRed), item(Form::Box, origin + Vec3{1, 0, 0}, {0.3, 0.3, 0.3}, kGreen)};
        return drawn(drawing);
    };
    // A power of two, so that differences from the eye's position are exact.
    CHECK(at({}).rgba == at({1048576, -2097152, 524288}).rgba);
}

TEST_CASE("meshes are kept until their revision changes")
{
    Drawing drawing = empty_drawing();
    const Picture nothing = drawn(drawing);
    const auto triangle = [](double size) { return Mesh{{{-size, 0, -size}, {size, 0, -size}, {0, 0, size}}, {0, 1, 2}}; };
    drawing.meshes = {triangle(1)};
    drawing.meshes_revision = 100;
    drawing.items = {item(Form::Mesh, {}, {}, kRed)};
    const Pixel large = pixel(drawn(drawing), 80, 75);
    CHECK_FALSE(large == pixel(nothing, 80, 75));
    drawing.meshes = {triangle(0.01)};
    CHECK(pixel(drawn(drawing), 80, 75) == large);
    drawing.meshes_revision = 101;
    CHECK(pixel(drawn(drawing), 80, 75) == pixel(nothing, 80, 75));
}

TEST_CASE("an item that is not finite is left out, the others are drawn")
{
    Drawing drawing = empty_drawing();
    drawing.items = {item(Form::Sphere, {}, {0.3, 0, 0}, kRed)};
    const Picture one = drawn(drawing);
    drawing.items.push_back(item(Form::Sphere, {0, -1, std::nan("")}, {1, 0, 0}, kGreen));
    drawing.items.push_back(item(Form::Plane, {std::numeric_limits<double>::infinity(), 0, 0}, {}, kGreen));
    CHECK(drawn(drawing).rgba == one.rgba);
}
