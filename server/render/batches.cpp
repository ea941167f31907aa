#include "batches.h"

#include <cstddef>

namespace plab::render
{
namespace
{

/// The outlines of spheres at these levels deviate from the circle by at most a third of a pixel, up to 130 and 500 pixels of
/// radius.
constexpr int kCoarseSphere = 3, kFineSphere = 4;
constexpr double kCoarsePixels = 130;
constexpr int kCylinderSides = 64, kRoundSides = 40, kCoarseSides = 8;
/// Shadows of spheres up to that radius in pixels are coarse discs.
constexpr double kCoarseShadow = 16;

void attribute(GLuint index, GLint size, GLsizei stride, std::size_t offset, GLuint divisor)
{
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, stride, reinterpret_cast<const void*>(offset));
    glVertexAttribDivisor(index, divisor);
}

template <class T>
void fill(GLenum target, const Buffer& buffer, const std::vector<T>& data, GLenum usage)
{
    glBindBuffer(target, buffer.name());
    glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), usage);
}

Vec3 scale_of(const Item& item)
{
    switch (item.form)
    {
        case Form::Sphere:
            return {item.size.x, item.size.x, item.size.x};
        case Form::Cylinder:
            return {item.size.x, item.size.x, item.size.z};
        case Form::Mesh:
            return {1, 1, 1};
        default:
            return item.size;
    }
}

Instance instance_of(const Item& item, const Frame& frame)
{
    const Quat& q = item.pose.q;
    return {floats(frame.from_eye(item.pose.p)),
            {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)},
            floats(scale_of(item)),
            floats(item.color)};
}

/// Smaller spheres, by their radius in pixels, are squares.
constexpr double kBallPixels = 60;

double pixels_of(double radius, const Vec3& from_eye, double pixels_per_radian)
{
    return radius / std::fmax(length(from_eye), 1e-9) * pixels_per_radian;
}

}  // namespace

Batch Batch::make(const Surface& surface)
{
    Batch out;
    out.array_ = VertexArray::make();
    out.corners_ = Buffer::make(), out.triangles_ = Buffer::make(), out.instance_buffer_ = Buffer::make();
    out.count_ = static_cast<GLsizei>(surface.triangles.size());
    glBindVertexArray(out.array_.name());
    fill(GL_ARRAY_BUFFER, out.corners_, surface.corners, GL_STATIC_DRAW);
    attribute(0, 3, sizeof(Corner), offsetof(Corner, position), 0);
    attribute(1, 3, sizeof(Corner), offsetof(Corner, normal), 0);
    fill(GL_ELEMENT_ARRAY_BUFFER, out.triangles_, surface.triangles, GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, out.instance_buffer_.name());
    attribute(2, 3, sizeof(Instance), offsetof(Instance, place), 1);
    attribute(3, 4, sizeof(Instance), offsetof(Instance, turn), 1);
    attribute(4, 3, sizeof(Instance), offsetof(Instance, size), 1);
    attribute(5, 3, sizeof(Instance), offsetof(Instance, color), 1);
    glBindVertexArray(0);
    return out;
}

void Batch::upload() const
{
    if (!instances_.empty()) fill(GL_ARRAY_BUFFER, instance_buffer_, instances_, GL_STREAM_DRAW);
}

void Batch::draw() const
{
    if (instances_.empty()) return;
    glBindVertexArray(array_.name());
    glDrawElementsInstanced(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(instances_.size()));
}

Batches Batches::make()
{
    Batches out;
    for (const int sides : {4, kCoarseSides, kRoundSides}) out.balls_.push_back(Batch::make(unit_disc(sides)));
    for (const int level : {kCoarseSphere, kFineSphere}) out.spheres_.push_back(Batch::make(unit_sphere(level)));
    out.box_and_cylinder_.push_back(Batch::make(unit_box()));
    out.box_and_cylinder_.push_back(Batch::make(unit_cylinder(kCylinderSides)));
    return out;
}

Result<void> Batches::keep_meshes(const Drawing& drawing)
{
    if (kept_ && revision_ == drawing.meshes_revision && meshes_.size() == drawing.meshes.size()) return {};
    kept_ = false;
    meshes_.clear(), mesh_radii_.clear();
    for (const Mesh& mesh : drawing.meshes)
    {
        const auto surface = surface_of(mesh);
        if (!surface) return reason("mesh " + std::to_string(meshes_.size()) + ": " + surface.error().reason);
        meshes_.push_back(Batch::make(*surface));
        mesh_radii_.push_back(radius_of(mesh));
    }
    revision_ = drawing.meshes_revision, kept_ = true;
    return {};
}

std::vector<Batch*> Batches::all()
{
    std::vector<Batch*> out;
    for (auto* group : {&balls_, &spheres_, &box_and_cylinder_, &meshes_})
        for (Batch& batch : *group) out.push_back(&batch);
    return out;
}

/// A barrel and two balls: not a form of its own, since its ends keep their shape when it is stretched.
void Batches::add_capsule(const Item& item, const Frame& frame)
{
    Item part = item;
    part.form = Form::Cylinder;
    add(part, frame);
    part.form = Form::Sphere;
    for (const double end : {-item.size.z, item.size.z})
    {
        part.pose.p = item.pose * Vec3{0, 0, end};
        add(part, frame);
    }
}

void Batches::add(const Item& item, const Frame& frame)
{
    if (item.form == Form::Capsule) return add_capsule(item, frame);
    const Instance instance = instance_of(item, frame);
    if (item.form == Form::Mesh) return meshes_[item.mesh].add(instance);
    if (item.form != Form::Sphere) return box_and_cylinder_[item.form == Form::Box ? 0 : 1].add(instance);
    const double pixels = pixels_of(item.size.x, frame.from_eye(item.pose.p), frame.pixels_per_radian);
    Batch& as_seen = pixels < kBallPixels ? balls_[0] : spheres_[pixels < kCoarsePixels ? 0 : 1];
    as_seen.add(instance);
    balls_[pixels < kCoarseShadow ? 1 : 2].add(instance);
}

Result<void> Batches::sort(const Drawing& drawing, const Frame& frame)
{
    for (Batch* batch : all()) batch->clear();
    for (const Item& item : drawing.items)
    {
        if (item.form == Form::Plane || !can_be_drawn(item)) continue;
        if (item.form == Form::Mesh && item.mesh >= meshes_.size())
            return reason("an item names mesh " + std::to_string(item.mesh) + "; there are " + std::to_string(meshes_.size()) +
                          ", numbered from 0");
        add(item, frame);
    }
    for (const Batch* batch : all()) batch->upload();
    return {};
}

void Batches::draw_solids(bool shadows) const
{
    for (const auto* group : {&spheres_, &box_and_cylinder_, &meshes_})
        for (const Batch& batch : *group)
            if (!shadows || group != &spheres_) batch.draw();
}

}  // namespace plab::render
