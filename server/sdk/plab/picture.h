/// The input of a drawing component (Phase::Draw), and the receiver of its pictures.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "plab/ref.h"
#include "plab/tables.h"

namespace plab
{

/// One visible object in its present state.
struct Visual
{
    const Geometry* geometry = nullptr;  ///< null: a shaft without a shape; `size` is then that of a plain axle
    Pose pose;                           ///< X_WS, including the shape's pose in its object
    Vec3 size;                           ///< axle: x radius, z half length, m
    Vec3 color{0.7, 0.7, 0.75};          ///< red, green, blue: 0 to 1
    std::uint32_t shape = kNoIndex;      ///< row of Shapes: equal numbers are equal geometry
};

struct NamedView
{
    std::string name;
    Vec3 position, look_at, up;  ///< W, m
    double field_of_view = 0.7;  ///< rad, vertical
};

/// Everything that can be seen at the end of a step.
struct RenderScene
{
    std::span<const Visual> visuals;
    std::span<const NamedView> views;         ///< cameras that the scene names
    std::span<const std::string> algorithms;  ///< a line for each interaction: "contact: CDetection/ODE"
    std::uint64_t shapes_revision = 0;        ///< changes when any geometry does
};

class ImageSink
{
public:
    virtual ~ImageSink() = default;
    /// Whether any client wants pictures now; if not, a component that only draws can skip its work.
    virtual bool wanted() const = 0;
    /// `rgba`: 4 bytes per pixel, rows from the top.
    virtual void show(std::uint32_t component, std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t> rgba) = 0;
};

}  // namespace plab
