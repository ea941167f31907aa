/// Components as text, with ids that are unique.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "import/assembly.h"
#include "import/robot.h"

namespace plab::import
{

/// Ids of a blueprint, made from names of the file.
class Ids
{
public:
    /// All ids begin with `prefix`.
    explicit Ids(std::string prefix = {}) : prefix_(std::move(prefix)) {}
    const std::string& prefix() const { return prefix_; }
    /// `name` with '_' for blanks and control characters, of at most 150 bytes, and with a number if it is taken.
    std::string make(std::string_view name);

private:
    std::string prefix_;
    std::set<std::string, std::less<>> taken_;
    std::map<std::string, std::size_t, std::less<>> next_;
};

/// " name='value'" of numbers; the shortest text that reads back as the same double.
std::string attribute(std::string_view name, std::string_view value);
std::string attribute(std::string_view name, double value);
std::string attribute(std::string_view name, const Vec3& v);
std::string attribute(std::string_view name, const Quat& q);
/// The same of a bound that is there; "" if it is infinite.
std::string bound(std::string_view name, double value);

/// <component id type attributes/>
std::string component(const std::string& id, std::string_view type, const std::string& attributes);
/// Whether a mesh is about what its convex hull is; a flat one has none.
bool is_convex(const TriangleMesh& mesh);
/// One <component> of kind Shape. Shapes that do not collide are triangles, as pLab has no others that are only seen.
std::string shape_component(const RobotShape& shape, const std::string& id);
/// mass, center_of_mass and inertia.
std::string mass_attributes(const MassProperties& mass);
/// Gives a body the largest red, green and blue of its shapes, and each shape what is left: their products are the shapes' colours.
/// Viewers that show one colour for a body show that one. None if no shape has a colour.
std::optional<Vec3> take_color(std::vector<RobotShape>& shapes);
/// <camera> that sees all bodies, from the front right; "" if there is nothing to see.
std::string camera(const Assembly& assembly);

}  // namespace plab::import
