/// Scenes and measures shared by the tests of solvers.
#pragma once

#include "support/scene.h"
#include "support/text.h"

namespace plab::test
{

/// An algorithm as a table names it: its type without "Solver/", and attributes.
struct SolverAlgorithm
{
    std::string type;
    std::string attributes = {};
};

inline std::string solver(const SolverAlgorithm& algorithm)
{
    return "<component id=\"solver\" type=\"Solver/" + algorithm.type + "\" " + algorithm.attributes + "/>";
}

inline std::string per_second(int steps) { return "dt=\"1/" + std::to_string(steps) + "\""; }

inline double observed_order(double coarse, double fine) { return std::log2(coarse / fine); }

/// w_WB in B, rad/s.
inline Vec3 body_spin(const Scene& s, const std::string& body)
{
    return rotate_back(s.quat(body, "orientation"), s.vec(body, "angular_velocity"));
}

/// m x'' = -k x - c x' along x; the spring's anchor is so far away that its length is never 0.
inline std::string spring_scene(const SolverAlgorithm& algorithm, double k, double c, double start = 1)
{
    return solver(algorithm) + "<component id=\"mass\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\" position=\"" + text(start) +
           " 0 0\"/><component id=\"spring\" type=\"Constraint/SpringDamper\" b=\"mass\" anchor_a=\"-2 0 0\" anchor_b=\"0 0 0\" "
           "length=\"2\""
           " stiffness=\"" +
           text(k) + "\" damping=\"" + text(c) + "\"/>";
}

/// n bodies that a medium slows down to nothing.
inline std::string braked(int n)
{
    std::string out;
    for (int i = 0; i < n; ++i)
        out += "<component id=\"b" + std::to_string(i) +
               "\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\" linear_velocity=\"1 2 3\" angular_velocity=\"0.1 0.2 0.3\"/>";
    return out + "<component id=\"drag\" type=\"Field/Drag\" between=\"*\" linear=\"5\" rotational=\"5\"/>";
}

}  // namespace plab::test
