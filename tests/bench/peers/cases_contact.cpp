// Cases d, e, f: balls, stacks, large scenes.
#include <cmath>
#include <limits>
#include <random>

#include "bench/peers/case.h"
#include "bench/peers/penetration.h"

namespace plab::peers
{
namespace
{

constexpr double kFailed = std::numeric_limits<double>::infinity();

/// Random numbers that are the same on every machine: those of std's distributions are not.
class Chance
{
public:
    explicit Chance(std::uint32_t seed) : engine_(seed) {}
    double between(double low, double high) { return low + (high - low) * (static_cast<double>(engine_()) / 4294967295.0); }
    Vec3 vector(double low, double high)
    {
        const double x = between(low, high), y = between(low, high), z = between(low, high);
        return {x, y, z};
    }

private:
    std::mt19937 engine_;
};

Scene balls(double lowest, double restitution)
{
    Scene scene;
    scene.name = restitution > 0 ? "elastic" : "plastic";
    scene.duration = 10, scene.ground = true, scene.restitution = restitution;
    Chance chance(1);
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            for (int k = 0; k < 6; ++k)
            {
                const Vec3 place{0.21 * i, 0.21 * j, lowest + 0.21 * k};
                scene.bodies.push_back(sphere(0.1, 10, place + chance.vector(0, 1e-3)));
            }
    return scene;
}

std::vector<double> measure_balls(const Scene& scene, const Trace& trace)
{
    std::vector<BodyState> start(scene.bodies.size());
    for (std::size_t i = 0; i < start.size(); ++i) start[i].position = scene.bodies[i].position;
    const double at_start = energy_of(scene, start);
    double depth = 0, worst = 0;
    for (std::size_t i = 0; i < trace.size(); ++i)
    {
        depth += penetration_of(scene, trace.at(i)).deepest;
        worst = std::fmax(worst, std::fabs(energy_of(scene, trace.at(i)) / at_start - 1));
    }
    return {depth / static_cast<double>(trace.size()), worst};
}

Case ball_case(const char* id, const char* title, const Scene& scene)
{
    Case c{id, title, {scene}, Sampling::Rate60, {}, {}, steps({60, 120, 240, 480, 1000})};
    c.metrics = {{"depth", "m", "mean over time of the deepest penetration"}, {"energy", "1", "worst relative error of the energy"}};
    if (scene.restitution > 0) std::swap(c.metrics[0], c.metrics[1]);
    const bool elastic = scene.restitution > 0;
    c.measure = [elastic](const Scene& s, const Trace& t)
    {
        std::vector<double> f = measure_balls(s, t);
        if (elastic) return std::vector<double>{f[1], f[0]};
        return std::vector<double>{f[0]};  // the energy that plastic impacts dissipate is not an error
    };
    if (!elastic) c.metrics.pop_back();
    return c;
}

Scene stack(const char* name, const std::vector<double>& masses)
{
    Scene scene;
    scene.name = name, scene.duration = 10, scene.ground = true, scene.friction = 0.8;
    for (std::size_t i = 0; i < masses.size(); ++i)
        scene.bodies.push_back(box({0.5, 0.5, 0.5}, masses[i], {0, 0, 0.5 + static_cast<double>(i)}));
    return scene;
}

std::vector<double> measure_stack(const Scene& scene, const Trace& trace)
{
    const Vec3 moved = trace.last().back().position - scene.bodies.back().position;
    const bool stands = length(moved) <= 0.5;
    const double shift = std::hypot(moved.x, moved.y);
    return {stands ? std::fabs(moved.z) : kFailed, stands ? shift : kFailed};
}

Case stack_case(const char* id, const char* title, const Scene& scene)
{
    Case c{id, title, {scene}, Sampling::End, {}, {}, steps({60, 120, 240, 480, 1000})};
    c.metrics = {{"sink", "m", "displacement of the top cube along z, where the stack stands"},
                 {"shift", "m", "displacement of the top cube across z"}};
    c.measure = measure_stack;
    return c;
}

Scene wall()
{
    Scene scene;
    scene.name = "wall", scene.duration = 3, scene.ground = true, scene.friction = 0.8;
    for (int k = 0; k < 25; ++k)
        for (int i = 0; i < 40; ++i)
            scene.bodies.push_back(box({0.5, 0.25, 0.25}, 1, {(i - 20) + (k % 2 == 1 ? 0.5 : 0.0), 0, 0.25 + 0.5 * k}));
    return scene;
}

Scene pile()
{
    Scene scene;
    scene.name = "pile", scene.duration = 2, scene.ground = true, scene.friction = 0.8;
    Chance chance(2);
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 25; ++j)
            for (int k = 0; k < 10; ++k)
            {
                Vec3 p = Vec3{0.55 * i, 0.55 * j, 0.27 + 0.52 * k};
                p.x += 0.02 * chance.between(-1, 1), p.y += 0.02 * chance.between(-1, 1);
                scene.bodies.push_back(box({0.25, 0.25, 0.25}, 1, p));
            }
    return scene;
}

Scene many_spheres()
{
    Scene scene;
    scene.name = "spheres", scene.duration = 2, scene.ground = true, scene.container = 2.7, scene.friction = 0.8;
    Chance chance(3);
    for (int i = 0; i < 25; ++i)
        for (int j = 0; j < 25; ++j)
            for (int k = 0; k < 16; ++k)
            {
                const Vec3 place = Vec3{0.211 * (i - 12), 0.211 * (j - 12), 0.12 + 0.211 * k};
                scene.bodies.push_back(sphere(0.1, 1, place + chance.vector(-0.004, 0.004)));
            }
    return scene;
}

Case large_case(const char* id, const char* title, const Scene& scene)
{
    Case c{id, title, {scene}, Sampling::End, {}, {}, steps({60})};
    c.metrics = {{"mean_depth", "m", "mean penetration of the pairs that overlap at the end"},
                 {"deepest", "m", "deepest penetration at the end"}};
    c.measure = [](const Scene& s, const Trace& t)
    {
        const Penetration p = penetration_of(s, t.last());
        return std::vector<double>{p.mean, p.deepest};
    };
    c.cpu_limit = 120;
    return c;
}

std::vector<double> doubling(int n)
{
    std::vector<double> out;
    for (int i = 0; i < n; ++i) out.push_back(std::ldexp(1.0, i));
    return out;
}

}  // namespace

void add_contact_cases(std::vector<Case>& out)
{
    out.push_back(ball_case("d-plastic", "d: 216 balls, plastic, 10 s", balls(0.101, 0)));
    out.push_back(ball_case("d-elastic", "d: 216 balls, elastic, 10 s", balls(1.101, 1)));
    out.push_back(stack_case("e-20", "e: 20 cubes, 10 s", stack("20 cubes", std::vector<double>(20, 1.0))));
    out.push_back(stack_case("e-512", "e: ten cubes of 1 to 512 kg, 10 s", stack("512:1", doubling(10))));
    out.push_back(stack_case("e-1000", "e: 1000 kg on 1 kg, 10 s", stack("1000:1", {1, 1000})));
    out.push_back(large_case("f-wall", "f: wall of 1000 boxes, 3 s", wall()));
    out.push_back(large_case("f-pile", "f: 5000 cubes, 2 s", pile()));
    out.push_back(large_case("f-spheres", "f: 10 000 spheres, 2 s", many_spheres()));
}

}  // namespace plab::peers
