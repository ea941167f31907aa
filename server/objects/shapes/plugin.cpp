#include "plab/plugin.h"

#include "composed.h"
#include "machine_parts.h"
#include "meshes.h"
#include "primitives.h"
#include "surfaces.h"

namespace
{

constexpr const char* kClosedForm = "volume, centre and inertia, in closed form";
constexpr const char* kAsDrawn = "volume, centre and inertia, exact for the wheel as drawn";
constexpr const char* kSurface = "refused: a surface has no volume";

template <auto Prepare, auto Measure, class Table>
void add_shape(plab::Registrar& registrar, std::string name, std::string doc, std::string measured)
{
    registrar.component<Table>(std::move(name), std::move(doc))
        .facet(plab::Facet::Shape)
        .family("Shape")
        .template command<Prepare>(plab::Phase::Prepare, "Shape/Prepare", "hands the geometry to the host")
        .template command<Measure>(plab::Phase::Measure, "Shape/VolumeIntegration", std::move(measured))
        .host_command(plab::Phase::Draw, "Shape/Draw", "shows the shape to viewers")
        .source(
            "B. Mirtich, Fast and accurate computation of polyhedral mass properties, J. Graphics Tools 1(2), 1996; "
            "F. Tonon, Explicit exact formulas for the 3-D tetrahedron inertia tensor, J. Math. Stat. 1(1), 2004");
}

}  // namespace

PLAB_PLUGIN("shapes", registrar)
{
    using namespace plab::shapes;
    add_shape<prepare_sphere, measure_sphere, SphereRows>(registrar, "Shape/Sphere", "a ball", kClosedForm);
    add_shape<prepare_box, measure_box, BoxRows>(registrar, "Shape/Box", "a cuboid", kClosedForm);
    add_shape<prepare_plane, measure_plane, PlaneRows>(registrar, "Shape/Plane", "a half space below z = 0 of its frame",
                                                       "refused: a plane has no volume");
    add_shape<prepare_mesh, measure_mesh, MeshRows>(
        registrar, "Shape/Mesh", "triangles; drawn and integrated as given, collides as its convex hull, as a surface, or not at all",
        "volume, centre and inertia, exact for closed triangle meshes");
    add_shape<prepare_cylinder, measure_cylinder, CylinderRows>(registrar, "Shape/Cylinder", "a solid cylinder along z", kClosedForm);
    add_shape<prepare_capsule, measure_capsule, CapsuleRows>(registrar, "Shape/Capsule", "a cylinder along z with half balls as ends",
                                                             kClosedForm);
    add_shape<prepare_convex_hull, measure_convex_hull, ConvexHullRows>(
        registrar, "Shape/ConvexHull", "the smallest convex solid around points; collides, is drawn and integrated as that",
        "volume, centre and inertia, exact for the hull");
    add_shape<prepare_compound, measure_compound, CompoundRows>(registrar, "Shape/Compound",
                                                                "several shapes as one, each with its own pose",
                                                                "the parts' sum by parallel axes; where they overlap, mass counts twice");
    add_shape<prepare_gear, measure_gear, GearRows>(registrar, "Shape/Gear", "a spur wheel with straight-flanked teeth, about z", kAsDrawn);
    add_shape<prepare_rotor, measure_rotor, RotorRows>(registrar, "Shape/Rotor", "a fan's wheel: hub and twisted blades, about z",
                                                       kAsDrawn);
    add_shape<prepare_bowl, measure_bowl, BowlRows>(registrar, "Shape/Bowl", "the inside of a sphere, open above a rim; bodies lie in it",
                                                    kSurface);
    add_shape<prepare_bore, measure_bore, BoreRows>(registrar, "Shape/Bore", "the inside of a cylinder along z, open at both ends",
                                                    kSurface);
    add_shape<prepare_height_field, measure_height_field, HeightFieldRows>(
        registrar, "Shape/HeightField", "ground: heights over a grid of squares, two triangles each", kSurface);
    add_shape<prepare_placed, measure_placed, PlacedRows>(registrar, "Shape/Placed", "another shape at another pose",
                                                          "those of the referred shape, moved");
}
