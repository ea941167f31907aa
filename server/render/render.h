/// Pictures of plain geometry, off-screen, with OSMesa. Independent of world and wire: both the viewer and the camera component
/// pass it a Drawing.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "picture/picture.h"
#include "plab/result.h"
#include "plab/rotation.h"
#include "plab/vector.h"

namespace plab::render
{

struct Mesh
{
    std::vector<Vec3> vertices;            ///< m
    std::vector<std::uint32_t> triangles;  ///< index triples, counter-clockwise seen from outside
};

enum class Form : std::uint8_t
{
    Sphere,    ///< size.x: radius
    Box,       ///< size: half extents
    Cylinder,  ///< size.x: radius, size.z: half length along z
    Capsule,   ///< size.x: radius, size.z: half length of its straight part along z
    Plane,     ///< z = 0 of its pose, as far as visible
    Mesh,
};

struct Item
{
    Form form = Form::Sphere;
    Pose pose;  ///< X_WS
    Vec3 size{0.5, 0.5, 0.5};
    Vec3 color{0.7, 0.7, 0.75};  ///< 0 to 1
    std::uint32_t mesh = 0;      ///< Form::Mesh: index into Drawing::meshes
};

struct View
{
    Vec3 position{4, -6, 3};
    Vec3 look_at;
    Vec3 up{0, 0, 1};
    double field_of_view = 0.7;  ///< rad, vertical
};

/// A line of text over the picture; from the top left, or from the bottom left if `bottom` is set.
struct Caption
{
    std::string text;
    bool bottom = false;
};

struct Drawing
{
    View view;
    std::vector<Item> items;
    std::vector<Mesh> meshes;
    std::uint64_t meshes_revision = 0;  ///< must change when `meshes` does, since OpenGL keeps them
    bool ground = true;                 ///< grid in the plane z = 0
    std::vector<Caption> captions;
};

using picture::Picture;

class Renderer
{
public:
    virtual ~Renderer() = default;
    /// Draws into `out`, whose memory is reused. Call it on one thread at a time.
    virtual Result<void> draw(const Drawing& drawing, Picture& out) = 0;
};

/// Sizes from 16 to 8192 pixels.
Result<std::unique_ptr<Renderer>> make_renderer(std::uint32_t width, std::uint32_t height);

/// A view that shows all items from a pleasant angle (azimuth and elevation in rad about their centre), in a picture at least
/// as wide as high. Planes and items that are not finite do not count.
View view_of_everything(const Drawing& drawing, double azimuth = -1.1, double elevation = 0.35);
/// The same for items that are not meshes, since a mesh item alone does not give its size.
View view_of_everything(const std::vector<Item>& items, double azimuth = -1.1, double elevation = 0.35);

}  // namespace plab::render
