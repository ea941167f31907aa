// Cases g, h, i: chain, gears, stiff springs.
#include <cmath>

#include "bench/peers/case.h"
#include "bench/peers/reference.h"

namespace plab::peers
{
namespace
{

constexpr int kLinks = 20;
constexpr double kLink = 0.5;  // m

Scene chain(JointKind kind, double duration)
{
    Scene scene;
    scene.name = kind == JointKind::Hinge ? "hinges" : "ball joints";
    scene.duration = duration;
    for (int i = 0; i < kLinks; ++i)
    {
        scene.bodies.push_back(box({0.25, 0.025, 0.025}, 1, {kLink * (i + 0.5), 0, 0}));
        JointSpec joint;
        joint.kind = kind, joint.parent = i - 1, joint.child = i, joint.anchor = {kLink * i, 0, 0};
        scene.joints.push_back(joint);
    }
    return scene;
}

std::vector<double> measure_chain(const Scene& scene, const Trace& trace)
{
    double scale = 0;  // J: the potential energy that the links would lose if the chain hung straight down
    for (int i = 0; i < kLinks; ++i) scale += 9.81 * kLink * (i + 0.5);
    double energy = 0, gap = 0;
    for (std::size_t k = 0; k < trace.size(); ++k)
    {
        const auto states = trace.at(k);
        energy = std::fmax(energy, std::fabs(energy_of(scene, states)) / scale);
        Vec3 end;
        for (const BodyState& s : states)
        {
            const Vec3 arm = rotate(normalized(s.orientation), {kLink / 2, 0, 0});
            gap = std::fmax(gap, length(s.position - arm - end));
            end = s.position + arm;
        }
    }
    return {energy, gap};
}

Case chain_case(const char* id, const char* title, JointKind kind, double duration)
{
    Case c{id, title, {chain(kind, duration)}, Sampling::Rate60, {}, {}, steps({60, 120, 240, 480, 1000, 2000})};
    c.metrics = {{"energy", "1", "worst relative error of the energy"}, {"gap", "m", "worst separation of a joint"}};
    c.measure = measure_chain;
    return c;
}

constexpr double kGearRatio = -0.5;

Scene gears()
{
    Scene scene;
    scene.name = "gears", scene.duration = 10, scene.gravity = {};
    for (int i = 0; i < 2; ++i)
    {
        BodySpec body;
        body.inertia = {1, 1, 1}, body.position = {1.5 * i, 0, 0};
        scene.bodies.push_back(body);
        JointSpec joint;
        joint.child = i, joint.anchor = body.position;
        scene.joints.push_back(joint);
    }
    scene.gears = {{0, 1, kGearRatio}};
    scene.loads = {{0, 1.0}};
    return scene;
}

/// Follows an angle about y through samples that are less than half a turn apart, or takes the engine's own count.
class Unwound
{
public:
    double next(const BodyState& s)
    {
        if (std::isfinite(s.turned)) return angle_ = s.turned;
        const double now = 2 * std::atan2(s.orientation.y, s.orientation.w);
        return angle_ += std::remainder(now - angle_, 2 * kPi);
    }

private:
    static constexpr double kPi = 3.14159265358979323846;
    double angle_ = 0;
};

std::vector<double> measure_gears(const Scene&, const Trace& trace)
{
    Unwound first, second;
    double phase = 0, angle = 0;
    for (std::size_t i = 0; i < trace.size(); ++i)
    {
        const double a = first.next(trace.at(i)[0]), b = second.next(trace.at(i)[1]);
        phase = std::fmax(phase, std::fabs(b - kGearRatio * a));
        angle = a;
    }
    const double t = trace.time.back();
    const double exact = 0.5 * t * t / (1 + kGearRatio * kGearRatio);
    return {std::fabs(angle / exact - 1), phase};
}

Case gear_case()
{
    Case c{"h", "h: pair of gears, 10 s", {gears()}, Sampling::Rate60, {}, {}, steps({30, 60, 120, 240, 480, 1000})};
    c.metrics = {{"angle", "1", "relative error of the driver's angle at the end"}, {"phase", "rad", "worst error of phase"}};
    c.measure = measure_gears;
    return c;
}

Scene spring_on_slider()
{
    Scene scene;
    scene.name = "spring", scene.duration = 1;
    scene.bodies = {box({0.1, 0.1, 0.1}, 1, {0, 0, 0})};
    JointSpec joint;
    joint.kind = JointKind::Slider, joint.axis = {0, 0, 1}, joint.stiffness = 1e6, joint.damping = 20, joint.rest = -0.01;
    scene.joints = {joint};
    return scene;
}

std::vector<double> measure_spring(const Scene& scene, const Trace& trace)
{
    const JointSpec& joint = scene.joints[0];
    const double rest = joint.rest + scene.gravity.z / joint.stiffness;
    double squares = 0, miss = 0;
    for (std::size_t i = 0; i < trace.size(); ++i)
    {
        miss = trace.at(i)[0].position.z - rest - damped_oscillation(1, joint.stiffness, joint.damping, -rest, trace.time[i]);
        squares += miss * miss;
    }
    return {std::sqrt(squares / static_cast<double>(trace.size())) / 0.01, std::fabs(miss) / 0.01};
}

Scene unequal_pair()
{
    Scene scene;
    scene.name = "1e-3 kg on 1e3 kg", scene.duration = 0.5, scene.gravity = {};
    scene.bodies = {box({0.1, 0.1, 0.1}, 1e3, {0, 0, 0}), box({0.1, 0.1, 0.1}, 1e-3, {1, 0, 0})};
    JointSpec joint;
    joint.kind = JointKind::Slider, joint.parent = 0, joint.child = 1, joint.axis = {1, 0, 0}, joint.anchor = {0.5, 0, 0};
    joint.stiffness = 1e6, joint.rest = -0.01;
    joint.damping = 2 * 0.01 * std::sqrt(joint.stiffness * 1e-3 * 1e3 / (1e3 + 1e-3));
    scene.joints = {joint};
    return scene;
}

std::vector<double> measure_pair(const Scene& scene, const Trace& trace)
{
    const JointSpec& joint = scene.joints[0];
    const double a = scene.bodies[0].mass, b = scene.bodies[1].mass, reduced = a * b / (a + b);
    const double swing = std::sqrt(joint.stiffness * reduced) * 0.01;  // N s, momentum of either at the first passage
    double squares = 0, momentum = 0;
    for (std::size_t i = 0; i < trace.size(); ++i)
    {
        const auto s = trace.at(i);
        const double stretch = (s[1].position - s[0].position - Vec3{1, 0, 0}).x - joint.rest;
        const double miss = stretch - damped_oscillation(reduced, joint.stiffness, joint.damping, -joint.rest, trace.time[i]);
        squares += miss * miss;
        momentum = std::fmax(momentum, length(a * s[0].velocity + b * s[1].velocity));
    }
    return {std::sqrt(squares / static_cast<double>(trace.size())) / 0.01, momentum / swing};
}

}  // namespace

void add_joint_cases(std::vector<Case>& out)
{
    out.push_back(chain_case("g-hinge-1s", "g: chain of 20 hinges, 1 s", JointKind::Hinge, 1));
    out.push_back(chain_case("g-hinge-10s", "g: chain of 20 hinges, 10 s", JointKind::Hinge, 10));
    out.push_back(chain_case("g-ball-1s", "g: chain of 20 ball joints, 1 s", JointKind::Ball, 1));
    out.push_back(chain_case("g-ball-10s", "g: chain of 20 ball joints, 10 s", JointKind::Ball, 10));
    out.push_back(gear_case());
    const std::vector<Step> fine = steps({60, 120, 240, 480, 1000, 2000, 4000});
    Case spring{"i-spring", "i: spring of 1000 rad/s on a slider, 1 s", {spring_on_slider()}, Sampling::EveryStep, {}, {}, fine};
    spring.metrics = {{"rms", "1", "RMS error of the displacement, relative to the amplitude"},
                      {"end", "1", "error of the displacement at the end, relative"}};
    spring.measure = measure_spring;
    out.push_back(spring);
    Case pair{"i-pair", "i: spring between 1e-3 and 1e3 kg, 0.5 s", {unequal_pair()}, Sampling::EveryStep, {}, {}, fine};
    pair.metrics = {{"rms", "1", "RMS error of the stretch, relative to the amplitude"},
                    {"momentum", "1", "worst error of momentum, relative to one body's"}};
    pair.measure = measure_pair;
    out.push_back(pair);
}

}  // namespace plab::peers
