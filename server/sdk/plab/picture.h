/// What a drawing component (Phase::Draw) sees, and where its pictures go.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "plab/ref.h"
#include "plab/tables.h"

namespace plab
{

/// One thing to be drawn, as it is now.
struct Visual
{
    const Geometry* geometry = nullptr;  ///< null: a shaft that has no shape; then `size` is that of a plain axle
    Pose pose;                           ///< X_WS, the shape's pose in its object included
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
struct Sight
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
    /// Whether anybody looks at pictures now; a component that only shows need not draw if nobody does.
    virtual bool wanted() const = 0;
    /// `rgba`: 4 bytes a pixel, rows from the top.
    virtual void show(std::uint32_t component, std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t> rgba) = 0;
};

}  // namespace plab
