// What the narrow phase costs for each pair of shapes: build/bin/bench_narrow prints the table of interactions/detection/README.md;
// with an argument, only pairs whose names contain it.
//
// Each pair is put into 300 random relative orientations and moved along a random direction until its gap is as wanted: clearly apart (a
// tenth of the size, as a broad phase with boxes a tenth larger passes them on), touching (a thousandth of the size deep), deep (a tenth
// of the size). Sizes are about 0.2 m; the margin for gaps is 1 mm. Times are processor time of one thread, the median of 9 rounds.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "detection/collider.h"
#include "detection/narrow.h"
#include "support/random_poses.h"

using namespace plab;
using namespace plab::detection;
using namespace plab::test;

namespace
{

constexpr double kSize = 0.2, kMargin = 1e-3;  // m
constexpr int kPoses = 300, kRounds = 9;

Collider hull_of(int points)
{
    std::uint64_t seed = 7;
    Geometry g;
    g.kind = GeometryKind::Mesh, g.hull_collides = true;
    for (int i = 0; i < points; ++i) g.vertices.push_back(normalized(random_vector(seed, 1)) * (0.5 * kSize));
    return Collider(g);
}

Collider solid_of(GeometryKind kind, const Vec3& size)
{
    Geometry g;
    g.kind = kind, g.size = size;
    return Collider(g);
}

struct Form
{
    std::string name;
    Collider collider;
};

struct Placed
{
    Pose a, b;
};

/// Moves b along n until the gap is as wanted, by bisection.
Placed placed(const Form& a, const Form& b, double gap, std::uint64_t& seed)
{
    Placed out;
    out.a.q = random_rotation(seed), out.b.q = random_rotation(seed);
    const Vec3 n = normalized(random_vector(seed, 1));
    double near = 0, far = 4 * kSize;
    for (int i = 0; i < 60; ++i)
    {
        const double middle = 0.5 * (near + far);
        out.b.p = middle * n;
        (separation(a.collider, out.a, b.collider, out.b).gap < gap ? near : far) = middle;
    }
    return out;
}

double seconds()
{
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// ns for each pair.
double cost(const Form& a, const Form& b, double gap)
{
    std::uint64_t seed = 11;
    std::vector<Placed> pairs;
    for (int i = 0; i < kPoses; ++i) pairs.push_back(placed(a, b, gap, seed));
    std::vector<double> rounds;
    ContactPoints points(kMargin);
    std::size_t sum = 0;
    for (int r = 0; r < kRounds; ++r)
    {
        const double start = seconds();
        for (const Placed& p : pairs)
        {
            points.clear(kMargin);
            collide(a.collider, p.a, b.collider, p.b, points);
            sum += points.all().size();
        }
        rounds.push_back((seconds() - start) * 1e9 / kPoses);
    }
    const bool should_touch = gap < kMargin;
    if (should_touch != (sum > 0)) std::fprintf(stderr, "%s, %s: %zu points at a gap of %g m\n", a.name.c_str(), b.name.c_str(), sum, gap);
    std::nth_element(rounds.begin(), rounds.begin() + kRounds / 2, rounds.end());
    return rounds[kRounds / 2];
}

}  // namespace

int main(int argc, char** argv)
{
    const std::string only = argc > 1 ? argv[1] : "";
    const double h = 0.5 * kSize;
    std::vector<Form> forms;
    forms.push_back({"box", solid_of(GeometryKind::Box, {h, h, h})});
    forms.push_back({"capsule", solid_of(GeometryKind::Capsule, {0.7 * h, 0, h})});
    forms.push_back({"cylinder", solid_of(GeometryKind::Cylinder, {h, 0, h})});
    forms.push_back({"hull of 20", hull_of(20)});
    forms.push_back({"hull of 300", hull_of(300)});
    std::printf("| pair | apart, ns | touching, ns | deep, ns |\n|---|---|---|---|\n");
    for (std::size_t i = 0; i < forms.size(); ++i)
        for (std::size_t k = i; k < forms.size(); ++k)
        {
            const std::string pair = forms[i].name + ", " + forms[k].name;
            if (pair.find(only) == std::string::npos) continue;
            std::printf("| %s |", pair.c_str());
            for (const double gap : {0.1 * kSize, -1e-3 * kSize, -0.1 * kSize}) std::printf(" %.3g |", cost(forms[i], forms[k], gap));
            std::printf("\n");
        }
    return 0;
}
