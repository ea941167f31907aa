/// What holds for a whole MJCF file: <compiler>, <option>, <default>, <asset>.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "import/document.h"
#include "import/robot.h"

namespace plab::import
{

class MjcfSettings
{
public:
    MjcfSettings(const XmlElement& root, Document& document);

    /// The element with the attributes of its class and those of its parents' classes; without its children.
    /// `inherited`: childclass of the enclosing body.
    XmlElement resolved(const XmlElement& e, const std::string& inherited);

    /// rad, of a number in the file's unit of angles.
    double angle(double value) const { return degrees_ ? value * kDegree : value; }
    /// pos and the orientation, in whichever form it is given.
    Pose pose(const XmlElement& e);
    /// None of the orientation's attributes.
    bool turned(const XmlElement& e) const;

    bool auto_limits() const { return auto_limits_; }
    bool inertia_from_shapes() const { return inertia_from_geom_ == "true"; }
    bool inertia_never_from_shapes() const { return inertia_from_geom_ == "false"; }
    /// kg that all bodies have together; not positive: what their own masses sum up to.
    double total_mass() const { return total_mass_; }
    /// Whether anything collides.
    bool collisions() const { return collisions_; }
    const std::string& step() const { return step_; }
    const Vec3& gravity() const { return gravity_; }
    std::optional<Vec3> material(const std::string& name) const;
    /// Null if there is no such mesh, or it could not be read (which is listed).
    std::shared_ptr<const TriangleMesh> mesh(const std::string& name) const;
    /// Whether this softness of contacts is met for the first time: many shapes have that of a class.
    bool is_new(const std::string& solref) { return softness_.insert(solref).second; }
    /// rgba as a colour.
    std::optional<Vec3> color(const XmlElement& e);

    static constexpr double kDegree = 0.017453292519943295;

private:
    using Attributes = std::map<std::string, std::string>;
    using Class = std::map<std::string, Attributes>;  ///< by element

    void read_compiler(const XmlElement& e);
    void read_option(const XmlElement& e);
    void read_class(const XmlElement& e, const Class& parent, const std::string& name);
    void read_assets(const XmlElement& e);
    void read_mesh(const XmlElement& e);
    void read_inline_mesh(const XmlElement& e, const std::string& name);
    Quat euler(const Vec3& angles);

    Document& document_;
    bool degrees_ = true, auto_limits_ = true, collisions_ = true;
    double total_mass_ = -1;
    std::string inertia_from_geom_ = "auto", euler_sequence_ = "xyz", mesh_folder_, step_ = "0.002";
    Vec3 gravity_{0, 0, -9.81};
    std::set<std::string> softness_;
    std::map<std::string, Class> classes_;
    std::map<std::string, Vec3> materials_;
    std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes_;
};

/// Whether an element of this name is an actuator that can be carried over.
bool is_actuator(std::string_view name);
/// Lists the attributes of <geom>, <joint>, assets and actuators that are not carried over; for elements and for their defaults.
void list_unused_attributes(const XmlElement& e, Document& document);

}  // namespace plab::import
