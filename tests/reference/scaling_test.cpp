// Changing the units only rescales the motion: lengths, masses and times scaled by powers of two change no bit.
#include <array>
#include <cstring>
#include <vector>

#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// By how much lengths, masses and times are larger: powers of two.
struct Scale
{
    double length = 1, mass = 1, time = 1;

    double speed() const { return length / time; }
    double acceleration() const { return length / (time * time); }
    double inertia() const { return mass * length * length; }
    double stiffness() const { return mass / (time * time); }
    double torque() const { return inertia() / (time * time); }
};

constexpr double kUp = 0x1p20, kDown = 0x1p-20;
constexpr std::array<Scale, 8> kScales{
    {{kUp, 1, 1}, {kDown, 1, 1}, {1, kUp, 1}, {1, kDown, 1}, {1, 1, kUp}, {1, 1, kDown}, {kUp, kDown, kUp}, {kDown, kUp, kDown}}};

std::string shape(const std::string& id, const std::string& type, const std::string& name, const Vec3& size)
{
    const std::string value = type == "Box" ? text(size) : text(size.x);
    return "<component id='" + id + "' type='Shape/" + type + "' " + name + "='" + value + "'/>";
}

std::string moving(const Scale& k, const std::string& id, double mass, const Vec3& inertia, const Vec3& at, const Vec3& v, const Vec3& w,
                   const std::string& more = "")
{
    return body(id, mass * k.mass, inertia * k.inertia(), at * k.length,
                "linear_velocity='" + text(v * k.speed()) + "' angular_velocity='" + text(w * (1 / k.time)) + "' " + more);
}

std::string weight(const Scale& k) { return gravity(text(Vec3{0.3, -0.2, -9.81} * k.acceleration())); }

std::string flying(const Scale& k)
{
    return weight(k) + moving(k, "a", 1.3, {.1, .2, .25}, {1, 2, 3}, {3, 1, 4}, {1, 5, 9}) +
           moving(k, "b", 0.7, {.3, .2, .25}, {-1, 2, 7}, {-3, 1, 0}, {2, 6, 5});
}

std::string hanging(const Scale& k)
{
    return weight(k) + moving(k, "a", 1.3, {.1, .2, .25}, {.5, 0, 0}, {}, {}) + moving(k, "b", 0.7, {.3, .2, .25}, {1.5, .1, 0}, {}, {}) +
           joint("pivot", "Hinge", "", "a", "anchor='0 0 0' axis='0.1 1 0'") +
           joint("link", "Ball", "a", "b", "anchor='" + text(Vec3{1, 0, 0} * k.length) + "'") +
           joint("spring", "SpringDamper", "a", "b",
                 "anchor_a='0 0 0' anchor_b='0 0 0' stiffness='" + text(20 * k.stiffness()) + "' damping='" + text(.3 * k.mass / k.time) +
                     "'");
}

std::string geared(const Scale& k, const std::string& type)
{
    const auto shaft = [&](const std::string& id, double inertia, double speed)
    {
        return "<component id='" + id + "' type='State/Shaft' inertia='" + text(inertia * k.inertia()) + "' angular_velocity='" +
               text(speed / k.time) + "'/>";
    };
    return shaft("s", .5, 3) + shaft("t", .2, 0) + shaft("u", .7, -1) + "<component id='g' type='Constraint/AngularVelocity/" + type +
           "' driver='s' driven='t' velocity_factor='-0.4'/><component id='h' type='Constraint/AngularVelocity/" + type +
           "' driver='t' driven='u' driver_teeth='17' driven_teeth='29'/><component id='load' type='Field/Load' between='s' "
           "shaft_torque='" +
           text(1.1 * k.torque()) + "'/>";
}

std::string bouncing(const Scale& k)
{
    return weight(k) + "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/>" +
           shape("ball", "Sphere", "radius", Vec3{.1, 0, 0} * k.length) +
           shape("box", "Box", "half_extents", Vec3{.1, .12, .15} * k.length) +
           moving(k, "a", 1.3, {.01, .01, .01}, {0, 0, .15}, {.2, 0, -1}, {1, 2, 3}, "shape='ball'") +
           moving(k, "b", 0.7, {.008, .007, .006}, {2, 0, .3}, {0, .3, -2}, {2, 1, 0}, "shape='box'") +
           "<component id='law' type='Response/Penalty' stiffness='" + text(1e5 * k.stiffness()) +
           "' friction='0.3' restitution='0.8'/><component id='contact' type='CDetection/ODE' between='a b' against='ground' "
           "response='law'/>";
}

/// States in the units of Scale{}.
std::vector<double> states_of(Scene& s, const Scale& k)
{
    std::vector<double> out;
    const auto add = [&](const Vec3& v, double unit) { out.insert(out.end(), {v.x / unit, v.y / unit, v.z / unit}); };
    for (const char* id : {"a", "b"})
    {
        if (s.simulation().world().find(id) == kNoIndex) continue;
        add(s.vec(id, "position"), k.length), add(s.vec(id, "linear_velocity"), k.speed());
        add(s.vec(id, "angular_velocity"), 1 / k.time);
        const Quat q = s.quat(id, "orientation");
        out.insert(out.end(), {q.w, q.x, q.y, q.z});
    }
    for (const char* id : {"s", "t", "u"})
        if (s.simulation().world().find(id) != kNoIndex) out.insert(out.end(), {s.angle(id), s.spin(id) * k.time});
    return out;
}

template <class MakeScene>
std::vector<std::vector<double>> run(const Scale& k, const std::string& solver, const MakeScene& make, int steps)
{
    Scene s(solver_is(solver) + make(k), "dt='" + text(k.time / 512) + "'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    std::vector<std::vector<double>> out;
    for (int i = 0; i < steps; ++i) s.step(), out.push_back(states_of(s, k));
    return out;
}

/// The first step at which two runs differ, or -1.
int first_difference(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b)
{
    for (std::size_t i = 0; i < a.size(); ++i)
        if (std::memcmp(a[i].data(), b[i].data(), a[i].size() * sizeof(double)) != 0) return static_cast<int>(i);
    return -1;
}

template <class MakeScene>
void check_scales(const std::string& solver, const MakeScene& make, int steps)
{
    CAPTURE(solver);
    const auto plain = run({}, solver, make, steps);
    for (const Scale& k : kScales)
    {
        const std::string scale = "length " + text(k.length) + ", mass " + text(k.mass) + ", time " + text(k.time);
        CAPTURE(scale);
        CHECK(first_difference(plain, run(k, solver, make, steps)) == -1);
    }
}

}  // namespace

TEST_CASE("scaling bodies in flight changes no bit, with every solver that has no tolerance of its own")
{
    for (const char* solver :
         {"RungeKutta4", "SemiImplicitEuler", "StoermerVerlet", "RotationSplitting", "ImplicitMidpoint", "Exact", "Automatic"})
        check_scales(solver, flying, 40);
}

TEST_CASE("scaling joints and springs changes no bit")
{
    for (const char* solver : {"RungeKutta4", "RotationSplitting", "StoermerVerlet"}) check_scales(solver, hanging, 200);
}

TEST_CASE("scaling gears changes no bit")
{
    for (const char* type : {"Graph", "Impulse", "Assign"})
        check_scales(
            "RungeKutta4", [&](const Scale& k) { return geared(k, type); }, 60);
}

TEST_CASE("scaling spring contacts changes no bit") { check_scales("RungeKutta4", bouncing, 300); }
