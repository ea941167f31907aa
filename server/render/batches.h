/// Sorts items into draw calls: one per surface, with all its instances.
#pragma once

#include <array>
#include <vector>

#include "forms.h"
#include "frame.h"
#include "gl.h"

namespace plab::render
{

/// The vertex shader's input for each item, with its memory layout.
struct Instance
{
    std::array<float, 3> place;  ///< relative to the eye
    std::array<float, 4> turn;   ///< x y z w
    std::array<float, 3> size;
    std::array<float, 3> color;
};

/// A surface in OpenGL's memory, and the items of this picture that use it.
class Batch
{
public:
    static Batch make(const Surface& surface);
    void clear() { instances_.clear(); }
    void add(const Instance& instance) { instances_.push_back(instance); }
    void upload() const;
    void draw() const;

private:
    Batch() = default;

    VertexArray array_;
    Buffer corners_, triangles_, instance_buffer_;
    GLsizei count_ = 0;
    std::vector<Instance> instances_;
};

class Batches
{
public:
    static Batches make();
    /// Uploads the drawing's meshes if their revision has changed.
    Result<void> keep_meshes(const Drawing& drawing);
    const std::vector<double>& mesh_radii() const { return mesh_radii_; }
    /// All items except planes; refuses an item whose mesh does not exist.
    Result<void> sort(const Drawing& drawing, const Frame& frame);
    /// Draws everything made of triangles. In the shadow pass, spheres are not.
    void draw_solids(bool shadows) const;
    /// Draws spheres that are small in the picture, as squares.
    void draw_balls() const { balls_[0].draw(); }
    /// Draws all spheres, as discs.
    void draw_ball_shadows() const { balls_[1].draw(), balls_[2].draw(); }

private:
    Batches() = default;
    void add(const Item& item, const Frame& frame);
    void add_capsule(const Item& item, const Frame& frame);
    std::vector<Batch*> all();

    std::vector<Batch> balls_;    ///< squares, coarse discs, round discs
    std::vector<Batch> spheres_;  ///< from coarse to fine
    std::vector<Batch> box_and_cylinder_;
    std::vector<Batch> meshes_;
    std::vector<double> mesh_radii_;
    std::uint64_t revision_ = 0;
    bool kept_ = false;
};

}  // namespace plab::render
