// Cases a, b, c: free flight, bouncing ball, sliding box.
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/peers/case.h"
#include "bench/peers/reference.h"

namespace plab::peers
{
namespace
{

double angle_between(const Quat& a, const Quat& b)
{
    const Quat d = conjugate(a) * normalized(b);
    return 2 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::fabs(d.w));
}

/// Angular momentum about the centre of mass, in W.
Vec3 momentum(const BodySpec& body, const BodyState& s)
{
    const Quat q = normalized(s.orientation);
    const Vec3 w = rotate_back(q, s.angular_velocity);
    return rotate(q, Vec3{body.inertia.x * w.x, body.inertia.y * w.y, body.inertia.z * w.z});
}

std::vector<double> measure_flight(const FreeRotation& reference, const Scene& scene, const Trace& trace)
{
    const BodySpec& body = scene.bodies[0];
    BodyState start;
    start.orientation = body.orientation, start.angular_velocity = body.angular_velocity;
    const Vec3 L0 = momentum(body, start);
    const double T0 = dot(L0, body.angular_velocity);
    double worst_angle = 0, worst_energy = 0, worst_momentum = 0, worst_position = 0, angle = 0;
    for (std::size_t i = 0; i < trace.size(); ++i)
    {
        const BodyState& s = trace.at(i)[0];
        const double t = trace.time[i];
        const Vec3 L = momentum(body, s);
        angle = angle_between(reference.attitude(t), s.orientation);
        worst_angle = std::fmax(worst_angle, angle);
        worst_energy = std::fmax(worst_energy, std::fabs(dot(L, s.angular_velocity) / T0 - 1));
        worst_momentum = std::fmax(worst_momentum, length(L - L0) / length(L0));
        worst_position =
            std::fmax(worst_position, length(s.position - (body.position + body.velocity * t + scene.gravity * (0.5 * t * t))));
    }
    return {angle, worst_energy, worst_momentum, worst_position, worst_angle};
}

std::vector<double> measure_bounce(const Scene& scene, const Trace& trace)
{
    const double radius = scene.bodies[0].half.x, g = -scene.gravity.z;
    const double drop = scene.bodies[0].position.z - radius;
    double squares = 0, worst = 0;
    for (std::size_t i = 0; i < trace.size(); ++i)
    {
        const BodyState& s = trace.at(i)[0];
        const double height = s.position.z - radius;
        const double miss = height - bouncing_height(drop, g, trace.time[i]);
        squares += miss * miss;
        worst = std::fmax(worst, std::fabs((0.5 * length_squared(s.velocity) + g * height) / (g * drop) - 1));
    }
    return {std::sqrt(squares / static_cast<double>(trace.size())), worst};
}

std::vector<double> measure_slide(const Scene& scene, const Trace& trace)
{
    const BodySpec& body = scene.bodies[0];
    const double speed = length(body.velocity);
    const double method = speed * speed / (2 * scene.friction * -scene.gravity.z);
    const BodyState& end = trace.last()[0];
    const Vec3 moved = end.position - body.position;
    const double turned = std::atan2(moved.y, moved.x) - std::atan2(body.velocity.y, body.velocity.x);
    return {std::fabs(std::hypot(moved.x, moved.y) / method - 1), std::fabs(turned), length(end.velocity)};
}

Case flight()
{
    Scene scene;
    scene.name = "flight", scene.duration = 20;
    BodySpec body;
    body.inertia = {1, 2, 3}, body.velocity = {1, 2, 98.1}, body.angular_velocity = {0.01, 5, 0.01};
    scene.bodies = {body};
    Case c{"a", "a: torque-free body in flight, 20 s", {scene}, Sampling::Rate30, {}, {}, steps({30, 60, 120, 240, 480, 1000, 2000, 4000})};
    c.metrics = {{"angle_end", "rad", "angle to the reference at the end"},
                 {"energy", "1", "worst relative error of the rotational energy"},
                 {"angular_momentum", "1", "worst relative error of the angular momentum"},
                 {"distance", "m", "worst distance from the parabola"},
                 {"angle_worst", "rad", "worst angle to the reference"}};
    const auto reference = std::make_shared<const FreeRotation>(body.inertia, body.angular_velocity, scene.duration);
    c.measure = [reference](const Scene& s, const Trace& t) { return measure_flight(*reference, s, t); };
    return c;
}

Case bounce()
{
    Scene scene;
    scene.name = "bounce", scene.duration = 10, scene.ground = true, scene.restitution = 1;
    scene.bodies = {sphere(0.1, 1, {0, 0, 1.1})};
    Case c{"b", "b: elastic ball, 10 s", {scene}, Sampling::EveryStep, {}, {}, steps({30, 60, 120, 240, 480, 1000, 2000, 4000})};
    c.metrics = {{"height_rms", "m", "RMS error of the height"}, {"energy", "1", "worst relative error of the energy"}};
    c.measure = measure_bounce;
    return c;
}

Case slide()
{
    Scene along;
    along.name = "slide", along.duration = 2, along.ground = true, along.friction = 0.4;
    along.bodies = {box({0.25, 0.25, 0.1}, 1, {0, 0, 0.1})};
    along.bodies[0].velocity = {3, 0, 0};
    Scene oblique = along;
    const double angle = std::atan(1.0) * 2 / 3;  // 30 degrees
    oblique.bodies[0].velocity = {3 * std::cos(angle), 3 * std::sin(angle), 0};
    Case c{"c", "c: sliding box, worse of 0 and 30 degrees", {along, oblique}, Sampling::End, {},
           {},  steps({60, 120, 240, 480, 1000, 2000, 4000})};
    c.metrics = {{"distance", "1", "relative error of the stopping distance"},
                 {"direction", "rad", "error of its direction"},
                 {"end_speed", "m/s", "speed at the end"}};
    c.measure = measure_slide;
    return c;
}

}  // namespace

void add_motion_cases(std::vector<Case>& out)
{
    out.push_back(flight());
    out.push_back(bounce());
    out.push_back(slide());
}

}  // namespace plab::peers
