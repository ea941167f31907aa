#include "bench/peers/case.h"

#include <algorithm>

namespace plab::peers
{

std::vector<Case> make_cases(const std::vector<std::string>& wanted)
{
    std::vector<Case> all;
    add_motion_cases(all);
    add_contact_cases(all);
    add_joint_cases(all);
    if (wanted.empty()) return all;
    const auto unwanted = [&wanted](const Case& c)
    { return std::none_of(wanted.begin(), wanted.end(), [&c](const std::string& w) { return c.id.compare(0, w.size(), w) == 0; }); };
    std::erase_if(all, unwanted);
    return all;
}

std::vector<Step> steps(std::initializer_list<int> per_second)
{
    std::vector<Step> out;
    for (const int n : per_second) out.push_back({1, n});
    return out;
}

double energy_of(const Scene& scene, std::span<const BodyState> states)
{
    double sum = 0;
    for (std::size_t i = 0; i < states.size(); ++i)
    {
        const BodySpec& body = scene.bodies[i];
        const BodyState& s = states[i];
        const Vec3 w = rotate_back(normalized(s.orientation), s.angular_velocity);
        sum += 0.5 * body.mass * length_squared(s.velocity) - body.mass * dot(scene.gravity, s.position) +
               0.5 * (body.inertia.x * w.x * w.x + body.inertia.y * w.y * w.y + body.inertia.z * w.z * w.z);
    }
    return sum;
}

}  // namespace plab::peers
