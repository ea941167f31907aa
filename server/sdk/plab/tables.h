/// The host tables, on which components interact. One array per field; an index is the index in a Ref, and stays valid as long as the
/// component exists. The world owns the tables; phase functions get them const or not, as their signature states.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "plab/ref.h"
#include "plab/vector.h"

namespace plab
{

enum class Motion : std::uint8_t
{
    Static,     ///< never moves
    Kinematic,  ///< moves with a prescribed velocity; forces do not affect it
    Dynamic,    ///< moves by forces
};

/// Rigid bodies in space. Frames: W world, B the body's frame as authored, C its centre of mass with B's axes. The angular momentum is
/// the state of a dynamic body's rotation and the angular velocity follows from it (see refresh_spin), so free rotation conserves angular
/// momentum to the last bit. A needle would lose its spin in this way, because the inverse of its smallest inertia multiplies every
/// rounding error of the momentum; for needles the angular velocity is the state.
struct Bodies
{
    std::vector<Motion> motion;
    std::vector<Vec3> position;           ///< p_WC, m
    std::vector<Quat> orientation;        ///< q_WB
    std::vector<Vec3> velocity;           ///< v_WC, m/s
    std::vector<Vec3> angular_velocity;   ///< w_WB in W, rad/s
    std::vector<Vec3> angular_momentum;   ///< about C, in W, N m s; dynamic bodies only
    std::vector<double> mass;             ///< kg
    std::vector<double> inverse_mass;     ///< 1/kg; 0 unless dynamic
    std::vector<std::uint8_t> needle;     ///< 1: principal inertias so different that the angular velocity is the state
    std::vector<Mat3> inertia_B;          ///< about C, in B, kg m^2
    std::vector<Mat3> inverse_inertia_B;  ///< 0 unless dynamic
    std::vector<Vec3> center_B;           ///< p_BC, m
    std::vector<std::uint32_t> material;  ///< index into Materials
    std::vector<RefList> shapes;          ///< Facet::Shape

    std::size_t size() const { return motion.size(); }
    bool dynamic(std::uint32_t i) const { return motion[i] == Motion::Dynamic; }
    /// X_WB, the frame as authored.
    Pose pose(std::uint32_t i) const { return {position[i] - rotate(orientation[i], center_B[i]), orientation[i]}; }
    /// Velocity of the point of body i that is at p_W.
    Vec3 velocity_at(std::uint32_t i, const Vec3& p_W) const { return velocity[i] + cross(angular_velocity[i], p_W - position[i]); }
    /// Inverse inertia about C in W.
    Mat3 inverse_inertia_W(std::uint32_t i) const
    {
        const Mat3 R = rotation_matrix(orientation[i]);
        return R * inverse_inertia_B[i] * transposed(R);
    }
    /// Recomputes the dependent one of momentum and spin from the one that is the state, after the state or the orientation has changed:
    /// w = R I_B^-1 R^T L.
    void refresh_spin(std::uint32_t i)
    {
        if (needle[i] != 0) return refresh_momentum(i);
        const Mat3 R = rotation_matrix(orientation[i]);
        angular_velocity[i] = R * (inverse_inertia_B[i] * transposed_times(R, angular_momentum[i]));
    }
    /// L from w, after w was set.
    void refresh_momentum(std::uint32_t i)
    {
        const Mat3 R = rotation_matrix(orientation[i]);
        angular_momentum[i] = R * (inertia_B[i] * transposed_times(R, angular_velocity[i]));
    }
    /// Adds to the angular momentum (N m s, W, about C) of a dynamic body.
    void add_angular_impulse(std::uint32_t i, const Vec3& l_W)
    {
        if (needle[i] != 0)
            angular_velocity[i] += inverse_inertia_W(i) * l_W;
        else
            angular_momentum[i] += l_W;
        refresh_spin(i);
    }
    /// Applies an impulse j (N s) at p_W; has no effect on a body that is not dynamic.
    void apply_impulse(std::uint32_t i, const Vec3& j, const Vec3& p_W)
    {
        if (!dynamic(i)) return;
        velocity[i] += j * inverse_mass[i];
        add_angular_impulse(i, cross(p_W - position[i], j));
    }
    double kinetic_energy(std::uint32_t i) const
    {
        return dynamic(i) ? 0.5 * mass[i] * length_squared(velocity[i]) + 0.5 * dot(angular_momentum[i], angular_velocity[i]) : 0.0;
    }
};

/// Shafts: one degree of freedom about an axle that is fixed in W.
struct Shafts
{
    std::vector<Motion> motion;
    std::vector<double> angle;            ///< rad, never wrapped
    std::vector<double> speed;            ///< rad/s
    std::vector<double> inertia;          ///< about the axle, kg m^2
    std::vector<double> inverse_inertia;  ///< 0 unless dynamic
    std::vector<Pose> axle;               ///< X_WA: origin on the axle, z along it, at angle 0; m
    std::vector<RefList> shapes;          ///< for drawing
    // Written by the host's constraint graph: angle = anchor + ratio * (angle of root - root_anchor).
    std::vector<std::uint32_t> root;  ///< the shaft that carries the motion; the shaft itself if nothing is coupled to it
    std::vector<double> ratio;        ///< turns per turn of the root; 1 if nothing is coupled to it
    std::vector<double> anchor;       ///< rad, own angle when the shafts were joined
    std::vector<double> root_anchor;  ///< rad, angle of the root at that time

    std::size_t size() const { return motion.size(); }
    bool dynamic(std::uint32_t i) const { return motion[i] == Motion::Dynamic; }
    Vec3 axis_W(std::uint32_t i) const { return rotate(axle[i].q, Vec3{0, 0, 1}); }
    double kinetic_energy(std::uint32_t i) const { return dynamic(i) ? 0.5 * inertia[i] * speed[i] * speed[i] : 0.0; }
};

/// Numbers without a place in space: z' = r, with rates r that interactions add. Temperatures, concentrations, currents.
struct Quantities
{
    std::vector<std::vector<double>> value;  ///< in the scene's own units

    std::size_t size() const { return value.size(); }
};

/// Volume, centre and inertia of a solid of density 1 kg/m^3, in the shape's parent (body) frame.
struct MassProperties
{
    double mass = 0;  ///< kg (= volume at density 1)
    Vec3 center;      ///< m
    Mat3 inertia;     ///< about the centre, kg m^2
};

enum class GeometryKind : std::uint8_t
{
    None,
    Sphere,
    Box,
    Plane,
    Mesh,      ///< triangles for drawing and integration; collides as its convex hull if `hull_collides`
    Capsule,   ///< all points within size.x of the segment from -size.z to size.z along z of S
    Cylinder,  ///< radius size.x, from -size.z to size.z along z of S
    Compound,  ///< `parts`, each with its own pose in S
};

struct Geometry
{
    GeometryKind kind = GeometryKind::None;
    Pose pose;                             ///< X_BS of the shape in its body
    Vec3 size;                             ///< sphere: x = radius; box: half extents; plane: unused (its normal is z of S)
    std::vector<std::uint32_t> parts;      ///< compound: rows of Shapes, none of them a compound or a plane
    std::vector<Vec3> vertices;            ///< mesh, in S, m
    std::vector<std::uint32_t> triangles;  ///< mesh: index triples, counter-clockwise seen from outside
    bool hull_collides = false;
    /// What set_mesh() knows of vertices and triangles, so that a step need not go through them: a digest (0: not known), and bounds (m).
    std::uint64_t mesh_digest = 0;
    Vec3 mesh_lower, mesh_upper;

    /// Sets vertices and triangles and what is known of them.
    void set_mesh(std::vector<Vec3> new_vertices, std::vector<std::uint32_t> new_triangles)
    {
        vertices = std::move(new_vertices), triangles = std::move(new_triangles);
        mesh_lower = mesh_upper = vertices.empty() ? Vec3{} : vertices.front();
        std::uint64_t digest = 1;
        const auto add = [&](std::uint64_t word) { digest = (digest ^ word) * 0x100000001b3ull, digest ^= digest >> 29; };
        for (const Vec3& v : vertices)
            for (int k = 0; k < 3; ++k)
            {
                add(std::bit_cast<std::uint64_t>(v[k]));
                mesh_lower[k] = std::min(mesh_lower[k], v[k]), mesh_upper[k] = std::max(mesh_upper[k], v[k]);
            }
        for (const std::uint32_t corner : triangles) add(corner);
        mesh_digest = digest == 0 ? 1 : digest;
    }
    /// Whether both have the same vertices and triangles.
    bool same_mesh(const Geometry& other) const
    {
        if (vertices.size() != other.vertices.size() || triangles.size() != other.triangles.size()) return false;
        if (mesh_digest != 0 && other.mesh_digest != 0) return mesh_digest == other.mesh_digest;
        return vertices == other.vertices && triangles == other.triangles;
    }
};

/// Shapes are shared by reference: several bodies may use one.
struct Shapes
{
    std::vector<Geometry> geometry;
    std::vector<MassProperties> solid;      ///< by Shape/VolumeIntegration; valid where unmeasurable is empty
    std::vector<std::string> unmeasurable;  ///< reason why there are no mass properties ("mesh is open at edge 3-7")
    std::size_t size() const { return geometry.size(); }
};

struct SurfaceLaw
{
    double friction = 0;     ///< Coulomb coefficient, 1
    double restitution = 0;  ///< Newton's coefficient, 0..1
    /// m: a couple of at most so much times the normal force resists rolling, and spinning about the normal.
    double rolling_friction = 0, spinning_friction = 0;

    bool resists_turning() const { return rolling_friction > 0 || spinning_friction > 0; }
};

/// Named materials and the laws between pairs of them (Material/Pair).
class Materials
{
public:
    /// The index of a name; the empty name, for a body without material, is 0.
    std::uint32_t intern(const std::string& name);
    void clear_pairs() { pairs_.clear(); }
    /// Sets the law for a pair, in either order. False if another component set it already.
    bool add_pair(std::uint32_t a, std::uint32_t b, const SurfaceLaw& law);
    /// The law of a pair, or null: then the response uses its own parameters.
    const SurfaceLaw* find_pair(std::uint32_t a, std::uint32_t b) const;
    bool any_resists_turning() const
    {
        return std::any_of(pairs_.begin(), pairs_.end(), [](const Pair& p) { return p.law.resists_turning(); });
    }

private:
    struct Pair
    {
        std::uint32_t a = 0, b = 0;
        SurfaceLaw law;
    };
    std::vector<std::string> names_{""};
    std::vector<Pair> pairs_;
};

inline std::uint32_t Materials::intern(const std::string& name)
{
    for (std::uint32_t i = 0; i < names_.size(); ++i)
        if (names_[i] == name) return i;
    names_.push_back(name);
    return static_cast<std::uint32_t>(names_.size() - 1);
}

inline bool Materials::add_pair(std::uint32_t a, std::uint32_t b, const SurfaceLaw& law)
{
    if (find_pair(a, b)) return false;
    pairs_.push_back({a, b, law});
    return true;
}

inline const SurfaceLaw* Materials::find_pair(std::uint32_t a, std::uint32_t b) const
{
    for (const Pair& p : pairs_)
        if ((p.a == a && p.b == b) || (p.a == b && p.b == a)) return &p.law;
    return nullptr;
}

}  // namespace plab
