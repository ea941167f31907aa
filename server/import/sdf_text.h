/// Values of SDF stand in the text of child elements: <mass>2</mass>. Poses: x y z roll pitch yaw, about the fixed axes x, y, z.
#pragma once

#include <string>
#include <string_view>

#include "import/document.h"

namespace plab::import
{

/// What follows reads the first child of that name. A missing one gives `otherwise`; a faulty one as well, with an error.
double sdf_number(const XmlElement& e, std::string_view child, double otherwise, Document& document);
bool sdf_truth(const XmlElement& e, std::string_view child, bool otherwise, Document& document);
Vec3 sdf_vector(const XmlElement& e, std::string_view child, const Vec3& otherwise, Document& document);
std::string sdf_text(const XmlElement& e, std::string_view child);

struct SdfPose
{
    Pose pose;
    std::string relative_to;  ///< "": the default of its element
};
/// <pose relative_to="..." degrees="..." rotation_format="...">.
SdfPose sdf_pose(const XmlElement& e, Document& document);

}  // namespace plab::import
