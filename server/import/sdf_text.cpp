#include "import/sdf_text.h"

#include <numbers>

namespace plab::import
{
namespace
{

constexpr double kDegree = std::numbers::pi / 180;

bool is_true(const std::string& text) { return text == "true" || text == "1"; }

Quat roll_pitch_yaw(const Vec3& a)
{
    return normalized(rotation_about({0, 0, 1}, a.z) * rotation_about({0, 1, 0}, a.y) * rotation_about({1, 0, 0}, a.x));
}

}  // namespace

double sdf_number(const XmlElement& e, std::string_view child, double otherwise, Document& document)
{
    const XmlElement* const found = find_child(e, child);
    double value = 0;
    if (!found) return otherwise;
    // The format's way to write "none" (its largest double) is not a number of pLab's files.
    const std::string_view text = trimmed(found->text);
    if (text == "inf" || text == "+inf" || text == "1e+308" || text == "1.7976931348623157e+308" || text == "1e308") return HUGE_VAL;
    if (text == "-inf" || text == "-1e+308" || text == "-1.7976931348623157e+308" || text == "-1e308") return -HUGE_VAL;
    return document.numbers_inside(*found, std::span(&value, 1), 1) == 1 ? value : otherwise;
}

bool sdf_truth(const XmlElement& e, std::string_view child, bool otherwise, Document& document)
{
    const XmlElement* const found = find_child(e, child);
    if (!found) return otherwise;
    const std::string text(trimmed(found->text));
    if (is_true(text) || text == "false" || text == "0") return is_true(text);
    return document.error(*found, "must be true or false, not '" + text + "'"), otherwise;
}

Vec3 sdf_vector(const XmlElement& e, std::string_view child, const Vec3& otherwise, Document& document)
{
    const XmlElement* const found = find_child(e, child);
    double v[3];
    return found && document.numbers_inside(*found, v, 3) == 3 ? Vec3{v[0], v[1], v[2]} : otherwise;
}

std::string sdf_text(const XmlElement& e, std::string_view child)
{
    const XmlElement* const found = find_child(e, child);
    return found ? std::string(trimmed(found->text)) : std::string();
}

SdfPose sdf_pose(const XmlElement& e, Document& document)
{
    const XmlElement* const found = find_child(e, "pose");
    SdfPose out;
    if (!found) return out;
    document.list_attributes(*found, {"relative_to", "frame", "degrees", "rotation_format"});
    out.relative_to = document.text(*found, "relative_to");
    if (out.relative_to.empty()) out.relative_to = document.text(*found, "frame");  // its name before version 1.7
    if (trimmed(found->text).empty()) return out;
    double v[7];
    const std::string format = document.text(*found, "rotation_format");
    if (format == "quat_xyzw")
    {
        if (document.numbers_inside(*found, v, 7) != 7) return out;
        const Quat q{v[6], v[3], v[4], v[5]};
        if (!(norm(q) > 1e-30)) return document.error(*found, "the quaternion must not be zero"), out;
        out.pose = {{v[0], v[1], v[2]}, normalized(q)};
        return out;
    }
    if (!format.empty() && format != "euler_rpy") return document.error(*found, "rotation_format cannot be '" + format + "'"), out;
    if (document.numbers_inside(*found, std::span(v, 6), 6) != 6) return out;
    const double unit = is_true(document.text(*found, "degrees")) ? kDegree : 1;
    out.pose = {{v[0], v[1], v[2]}, roll_pitch_yaw(Vec3{v[3], v[4], v[5]} * unit)};
    return out;
}

}  // namespace plab::import
