#include "ros/joints.h"

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

namespace plab::ros
{
namespace
{

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

const link::Parameter* find_parameter(const std::vector<link::Parameter>& parameters, std::string_view name)
{
    for (const link::Parameter& p : parameters)
        if (p.name == name) return &p;
    return nullptr;
}

/// N numbers with blanks between them.
template <std::size_t N>
std::optional<std::array<double, N>> numbers_of(const std::vector<link::Parameter>& parameters, std::string_view name)
{
    const link::Parameter* const p = find_parameter(parameters, name);
    if (p == nullptr) return {};
    std::array<double, N> out{};
    const char *at = p->text.data(), *const end = at + p->text.size();
    for (double& number : out)
    {
        while (at != end && *at == ' ') ++at;
        const auto [next, error] = std::from_chars(at, end, number);
        if (error != std::errc() || !std::isfinite(number)) return {};
        at = next;
    }
    return out;
}

std::optional<Vec3> vector_parameter(const std::vector<link::Parameter>& parameters, std::string_view name)
{
    const auto n = numbers_of<3>(parameters, name);
    return n ? std::optional(Vec3{(*n)[0], (*n)[1], (*n)[2]}) : std::nullopt;
}

std::optional<Quat> rotation_parameter(const std::vector<link::Parameter>& parameters, std::string_view name)
{
    const auto n = numbers_of<4>(parameters, name);
    return n ? std::optional(Quat{(*n)[0], (*n)[1], (*n)[2], (*n)[3]}) : std::nullopt;
}

/// The member of a role that takes one; "" if it is empty.
std::string member_of(const link::Interaction& interaction, std::string_view role)
{
    for (const link::Participants& r : interaction.roles)
        if (r.role == role && !r.members.empty()) return r.members.front();
    return {};
}

/// The angle of a turn about z, within half a turn.
double twist_of(const Quat& q) { return 2 * std::atan2(q.z * (q.w < 0 ? -1 : 1), std::abs(q.w)); }

/// The value nearest to `expected` that differs from `twist` by whole turns.
double unwrapped(double twist, double expected)
{
    constexpr double kTurn = 2 * std::numbers::pi;
    return twist + kTurn * std::round((expected - twist) / kTurn);
}

}  // namespace

void JointMessage::rebuild(const link::CatalogueContents& scene, const SceneFrames& frames, NameTable& names)
{
    const std::map<std::string, Joint> before = std::move(joints_);
    joints_.clear(), has_drives_ = false;
    for (const auto& [id, interaction] : scene.interactions)
        if (auto joint = joint_of(interaction, scene, frames))
        {
            // Whole turns that were counted go on counting.
            const auto known = before.find(id);
            if (known != before.end() && known->second.kind == joint->kind)
                joint->angle = known->second.angle, joint->time = known->second.time, joint->speed = known->second.speed;
            joints_.emplace(id, std::move(*joint));
        }
    for (const SceneFrame& frame : frames.all())
        if (frame.is_shaft)
        {
            Joint shaft;
            shaft.kind = Kind::Shaft, shaft.b.handle = frame.handle, shaft.b.pose = frame.pose;
            joints_.emplace(frame.id, std::move(shaft));
        }
    for (auto& [id, joint] : joints_) joint.name = names.name_of(id);
    find_drives(scene);
}

std::optional<JointMessage::Joint> JointMessage::joint_of(const link::Interaction& joint, const link::CatalogueContents& scene,
                                                          const SceneFrames& frames) const
{
    const bool is_hinge = joint.type_name == "Constraint/Hinge";
    if (!is_hinge && joint.type_name != "Constraint/Slider") return {};
    Joint out;
    out.kind = is_hinge ? Kind::Hinge : Kind::Slider;
    for (const auto& [side, role] : {std::pair(&out.a, "a"), std::pair(&out.b, "b")})
    {
        const std::string suffix = role;
        const auto frame = rotation_parameter(joint.parameters, "frame_" + suffix);
        const auto point = vector_parameter(joint.parameters, "point_" + suffix);
        if (!frame || !point) return {};
        side->frame = *frame, side->point = *point;
        const std::string id = member_of(joint, role);
        if (id.empty()) continue;
        const SceneFrame* const body = frames.find_id(id);
        if (body == nullptr || body->is_shaft) return {};
        side->pose = body->pose;
        if (!body->is_static) side->handle = body->handle;
    }
    if (const auto travelled = numbers_of<1>(joint.parameters, "travelled")) out.travelled = travelled->front();
    if (const auto angle = numbers_of<1>(joint.parameters, "angle")) out.angle = angle->front();
    if (scene.server) out.time = scene.server->time;
    return out;
}

void JointMessage::find_drives(const link::CatalogueContents& scene)
{
    // By what they lie between and what they move along.
    std::multimap<std::string, Drive> drives;
    const auto key_of = [](const link::Interaction& i, std::string_view along)
    { return member_of(i, "a") + "\n" + member_of(i, "b") + "\n" + std::string(along); };
    for (const auto& [id, interaction] : scene.interactions)
    {
        const bool is_motor = interaction.type_name == "Constraint/Motor";
        if (!is_motor && interaction.type_name != "Constraint/TorsionSpring") continue;
        const link::Parameter* const along = find_parameter(interaction.parameters, "along");
        drives.emplace(key_of(interaction, along == nullptr ? "turn" : along->text), Drive{id, is_motor});
    }
    if (drives.empty()) return;
    for (auto& [id, joint] : joints_)
    {
        const auto own = scene.interactions.find(id);
        if (own == scene.interactions.end()) continue;
        const auto [first, last] = drives.equal_range(key_of(own->second, joint.kind == Kind::Hinge ? "turn" : "slide"));
        for (auto at = first; at != last; ++at) joint.drives.push_back(at->second), has_drives_ = true;
    }
}

std::optional<JointMessage::Coordinate> JointMessage::between(Joint& joint, double time) const
{
    Pose X_a = joint.a.pose, X_b = joint.b.pose;
    Vec3 v_a, w_a, v_b, w_b;
    for (const auto& [side, X, v, w] : {std::tuple(&joint.a, &X_a, &v_a, &w_a), std::tuple(&joint.b, &X_b, &v_b, &w_b)})
    {
        if (!side->handle) continue;
        const auto at = bodies_.find(*side->handle);
        if (at == bodies_.end()) return {};
        *X = pose_of(*at->second), *v = vec(at->second->linear_velocity), *w = vec(at->second->angular_velocity);
    }
    const Quat frame_a = X_a.q * joint.a.frame, frame_b = X_b.q * joint.b.frame;
    Coordinate out;
    out.axis = rotate(frame_a, Vec3{0, 0, 1});
    if (joint.kind == Kind::Slider)
    {
        const Vec3 arm_a = rotate(X_a.q, joint.a.point), arm_b = rotate(X_b.q, joint.b.point);
        const Vec3 d = X_b.p + arm_b - X_a.p - arm_a;
        out.position = dot(out.axis, d) + joint.travelled;
        out.speed = dot(out.axis, v_b + cross(w_b, arm_b) - v_a - cross(w_a, arm_a)) + dot(cross(w_a, out.axis), d);
        return out;
    }
    out.speed = dot(out.axis, w_b - w_a);
    // A frame that is earlier than the last one is of another run: then nothing is known of whole turns.
    const double since = time - joint.time;
    const double expected = since >= 0 ? joint.angle + 0.5 * (joint.speed + out.speed) * since : 0;
    joint.angle = unwrapped(twist_of(conjugate(frame_a) * frame_b), expected);
    joint.time = time, joint.speed = out.speed;
    out.position = joint.angle;
    return out;
}

std::optional<JointMessage::Coordinate> JointMessage::coordinate_of(Joint& joint, const plab_v2_Frame& frame) const
{
    if (joint.kind != Kind::Shaft) return between(joint, frame.time);
    const auto at = shafts_.find(*joint.b.handle);
    if (at == shafts_.end()) return {};
    return Coordinate{at->second->angle, at->second->speed, {}};
}

namespace
{

/// Of one motor or spring, along the joint's axis.
double effort_of(const link::InteractionMetrics& metrics, bool is_motor, bool turns, const Vec3& axis)
{
    if (!is_motor)
    {
        const auto effort = numbers_of<1>(metrics.outputs, "effort");
        return effort ? effort->front() : kUnknown;
    }
    const auto reaction = vector_parameter(metrics.outputs, turns ? "torque" : "force");
    return reaction ? dot(axis, *reaction) : kUnknown;
}

}  // namespace

const msg::JointState& JointMessage::of(const plab_v2_Frame& frame, const link::Metrics* metrics)
{
    bodies_.clear(), shafts_.clear(), names_.clear(), positions_.clear(), speeds_.clear(), efforts_.clear();
    for (const plab_v2_BodyState& body : wire::items(frame.bodies)) bodies_.emplace(body.handle, &body);
    for (const plab_v2_ShaftState& shaft : wire::items(frame.shafts)) shafts_.emplace(shaft.handle, &shaft);
    std::unordered_map<std::string_view, const link::InteractionMetrics*> measured;
    if (metrics != nullptr && has_drives_)
        for (const link::InteractionMetrics& m : metrics->interactions) measured.emplace(m.component_id, &m);
    for (auto& [id, joint] : joints_)
    {
        const auto coordinate = coordinate_of(joint, frame);
        if (!coordinate) continue;
        double effort = joint.drives.empty() || measured.empty() ? kUnknown : 0;
        for (const Drive& drive : joint.drives)
        {
            const auto at = measured.find(drive.id);
            const bool turns = joint.kind == Kind::Hinge;
            effort += at == measured.end() ? kUnknown : effort_of(*at->second, drive.is_motor, turns, coordinate->axis);
        }
        names_.push_back(wire::text(joint.name));
        positions_.push_back(coordinate->position), speeds_.push_back(coordinate->speed), efforts_.push_back(effort);
    }
    // sensor_msgs/JointState: what is not known of any joint has no entries at all.
    if (measured.empty()) efforts_.clear();
    message_.header = {time_of(frame.time), wire::text("")};
    show(message_.name, names_), show(message_.position, positions_), show(message_.velocity, speeds_), show(message_.effort, efforts_);
    return message_;
}

}  // namespace plab::ros
