/// What is refused, with which message; PNG files; the view of everything.
#include <png.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "pictures.h"

using namespace plab;
using namespace plab::render;
using namespace plab::test;

namespace
{

std::string refusal_of(const Drawing& drawing)
{
    auto renderer = make_renderer(64, 64);
    REQUIRE(renderer.ok());
    Picture out;
    const auto done = (*renderer)->draw(drawing, out);
    return done ? "accepted" : done.error().reason;
}

std::vector<std::uint8_t> read_back(const std::string& path)
{
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&image, path.c_str()) != 0);
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> out(PNG_IMAGE_SIZE(image));
    REQUIRE(png_image_finish_read(&image, nullptr, out.data(), 0, nullptr) != 0);
    return out;
}

std::string temporary(const std::string& name) { return (std::filesystem::temp_directory_path() / ("plab_render_test_" + name)).string(); }

}  // namespace

TEST_CASE("sizes that no picture can have are refused")
{
    for (const auto& [width, height] : {std::pair{15u, 100u}, {100u, 15u}, {0u, 0u}, {8193u, 100u}, {100u, 4294967295u}})
    {
        const auto made = make_renderer(width, height);
        REQUIRE_FALSE(made.ok());
        CHECK(made.error().reason == "a picture must have from 16 to 8192 pixels in each direction, not " + std::to_string(width) + " x " +
                                         std::to_string(height));
    }
    CHECK(make_renderer(16, 16).ok());
}

TEST_CASE("a view that shows nothing is refused, an unusual one is not")
{
    Drawing drawing;
    CHECK(refusal_of(drawing) == "accepted");
    drawing.view.look_at = drawing.view.position;
    CHECK(refusal_of(drawing) == "the view must look at a point that is not its own position");
    drawing.view.look_at = {};
    drawing.view.field_of_view = 3.2;
    CHECK(refusal_of(drawing) == "the view's field of view must lie between 0 and pi");
    drawing.view.field_of_view = 0.7;
    drawing.view.up.x = std::nan("");
    CHECK(refusal_of(drawing) == "the view is not finite; position, look_at and up must be");
    drawing.view.up = {0, 0, 1}, drawing.view.position = {0, 0, 5};
    CHECK(refusal_of(drawing) == "accepted");
    drawing.view.up = {};
    CHECK(refusal_of(drawing) == "accepted");
}

TEST_CASE("meshes with bad numbers and items without their mesh are refused")
{
    Drawing drawing;
    drawing.items = {item(Form::Mesh, {}, {}, kRed)};
    CHECK(refusal_of(drawing) == "an item names mesh 0; there are 0, numbered from 0");
    drawing.meshes = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}}, {{{0, 0, 0}, {1, 0, 0}}, {0, 1, 2}}};
    CHECK(refusal_of(drawing) == "mesh 1: triangle 0 names vertex 2; there are 2 vertices, numbered from 0");
    drawing.meshes[1].triangles = {0, 1};
    CHECK(refusal_of(drawing) == "mesh 1: triangles must be triples of vertex numbers, not 2 numbers");
    drawing.meshes.pop_back();
    CHECK(refusal_of(drawing) == "accepted");
}

TEST_CASE("a picture reads back from its file unchanged")
{
    Drawing drawing = empty_drawing();
    drawing.items = {item(Form::Sphere, {}, {0.5, 0, 0}, kRed)};
    Picture picture = drawn(drawing);
    picture.rgba[3] = 17;
    const std::string path = temporary("picture.png");
    REQUIRE(picture::write_png(path, picture).ok());
    CHECK(read_back(path) == picture.rgba);
    CHECK_FALSE(std::filesystem::exists(path + ".part"));
    picture.rgba[0] ^= 255;  // an old file is replaced
    REQUIRE(picture::write_png(path, picture).ok());
    CHECK(read_back(path) == picture.rgba);
    std::filesystem::remove(path);
}

TEST_CASE("a picture that cannot be written leaves nothing behind")
{
    const Picture small{2, 1, {1, 2, 3, 4, 5, 6, 7, 8}}, torn{2, 2, {1, 2, 3, 4}}, none{};
    const std::string torn_reason = "a picture of 2 x 2 pixels must have 16 bytes and at least one pixel, not 4 bytes";
    CHECK(picture::write_png(temporary("torn.png"), torn).error().reason == torn_reason);
    CHECK_FALSE(picture::write_png(temporary("none.png"), none).ok());
    CHECK_FALSE(picture::write_png(temporary("no/such/folder.png"), small).ok());
    const std::string folder = temporary("folder");
    std::filesystem::create_directory(folder);
    std::filesystem::create_directory(folder + "/inside");
    CHECK_FALSE(picture::write_png(folder, small).ok());
    CHECK_FALSE(std::filesystem::exists(folder + ".part"));
    std::filesystem::remove_all(folder);
}

TEST_CASE("the view of everything contains every ball of the scene")
{
    Drawing drawing;
    drawing.meshes = {{{{0, 0, 0}, {3, 0, 0}, {0, 1, 0}}, {0, 1, 2}}};
    drawing.items = {item(Form::Sphere, {10, 0, 0}, {1, 0, 0}, kRed), item(Form::Box, {-4, 5, 2}, {1, 2, 3}, kRed),
                     item(Form::Mesh, {0, -20, 1}, {}, kRed), item(Form::Plane, {0, 0, -1e6}, {}, kRed),
                     item(Form::Sphere, {std::nan(""), 0, 0}, {1, 0, 0}, kRed)};
    for (const double azimuth : {-1.1, 0.0, 2.5})
    {
        const View view = view_of_everything(drawing, azimuth, 0.35);
        const Vec3 along = normalized(view.look_at - view.position);
        const Vec3 right = normalized(cross(along, view.up)), up = cross(right, along);
        const auto inside = [&](const Vec3& p, double radius)
        {
            const Vec3 method = p - view.position;
            const double angle = 0.5 * view.field_of_view, most = std::fmax(std::fabs(dot(method, right)), std::fabs(dot(method, up)));
            return most * std::cos(angle) + radius < dot(method, along) * std::sin(angle);
        };
        CHECK(inside({10, 0, 0}, 1));
        CHECK(inside({-4, 5, 2}, std::sqrt(14)));
        CHECK(inside({0, -20, 1}, 3));
        CHECK(std::atan2(-along.y, -along.x) == doctest::Approx(azimuth));
        CHECK(std::asin(-along.z) == doctest::Approx(0.35));
    }
    CHECK(refusal_of({view_of_everything(std::vector<Item>{}), {}, {}, 0, true, {}}) == "accepted");
}
