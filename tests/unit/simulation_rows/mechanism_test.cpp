// Rows on host tables alone: multipliers against a dense solution, orders, mass ratios, redundancy, contradictions.
#include <algorithm>

#include "mechanism.h"

using namespace plab;
using namespace plab::test;

namespace
{

using Long = long double;

/// A RowSink that keeps what it is given.
struct Kept : RowSink
{
    void begin(std::uint32_t) override {}
    void add(const ConstraintRow& row) override { rows.push_back(row); }
    std::vector<ConstraintRow> rows;
};

/// Gaussian elimination with pivoting, in long double.
std::vector<Long> solve_dense(std::vector<std::vector<Long>> a, std::vector<Long> b)
{
    const std::size_t n = b.size();
    for (std::size_t c = 0; c < n; ++c)
    {
        std::size_t p = c;
        for (std::size_t r = c + 1; r < n; ++r)
            if (std::fabs(a[r][c]) > std::fabs(a[p][c])) p = r;
        std::swap(a[p], a[c]), std::swap(b[p], b[c]);
        for (std::size_t r = c + 1; r < n; ++r)
        {
            const Long f = a[r][c] / a[c][c];
            if (f == 0) continue;
            for (std::size_t k = c; k < n; ++k) a[r][k] -= f * a[c][k];
            b[r] -= f * b[c];
        }
    }
    for (std::size_t c = n; c-- > 0;)
    {
        for (std::size_t k = c + 1; k < n; ++k) b[c] -= a[c][k] * b[k];
        b[c] /= a[c][c];
    }
    return b;
}

/// Accelerations of centres of mass by the whole matrix of M and J.
std::vector<Vec3> dense_accelerations(Mechanism& m)
{
    Kept kept;
    m.constrain({}, kept);
    const Bodies& b = m.host.bodies;
    const std::size_t n = 6 * b.size(), all = n + kept.rows.size();
    std::vector<std::vector<Long>> a(all, std::vector<Long>(all, 0));
    std::vector<Long> rhs(all, 0);
    for (std::uint32_t i = 0; i < b.size(); ++i)
    {
        const Mat3 R = rotation_matrix(b.orientation[i]);
        const Mat3 inertia = R * b.inertia_B[i] * transposed(R);
        const Vec3 gyro = cross(b.angular_velocity[i], inertia * b.angular_velocity[i]);
        for (int r = 0; r < 3; ++r)
        {
            const std::size_t u = 6 * i + static_cast<std::size_t>(r);
            a[u][u] = b.mass[i];
            rhs[u] = m.gravity[r] * b.mass[i], rhs[u + 3] = -gyro[r];
            for (int c = 0; c < 3; ++c) a[u + 3][6 * i + 3 + static_cast<std::size_t>(c)] = inertia(r, c);
        }
    }
    for (std::size_t k = 0; k < kept.rows.size(); ++k)
    {
        const ConstraintRow& row = kept.rows[k];
        for (std::uint32_t j = 0; j < row.count; ++j)
            for (int c = 0; c < 3; ++c)
            {
                const std::size_t u = 6 * row.blocks[j].participant.index + static_cast<std::size_t>(c);
                a[n + k][u] = a[u][n + k] = row.blocks[j].linear[c];
                a[n + k][u + 3] = a[u + 3][n + k] = row.blocks[j].angular[c];
            }
        rhs[n + k] = row.bias;
    }
    const auto x = solve_dense(a, rhs);
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < b.size(); ++i)
        out.push_back({static_cast<double>(x[6 * i]), static_cast<double>(x[6 * i + 1]), static_cast<double>(x[6 * i + 2])});
    return out;
}

/// Of all bodies but the first, relative to the largest acceleration.
double worst_difference(Mechanism& m, std::size_t from = 0)
{
    const auto dense = dense_accelerations(m);
    m.evaluate();
    double worst = 0, scale = 0;
    for (std::size_t i = from; i < dense.size(); ++i)
    {
        worst = std::fmax(worst, length(m.wrenches.force[i] * m.host.bodies.inverse_mass[i] - dense[i]));
        scale = std::fmax(scale, length(dense[i]));
    }
    return worst / scale;
}

/// Spins and attitudes that violate the joints: at acceleration level that does not matter.
void stir(Mechanism& m)
{
    for (std::uint32_t i = 0; i < m.host.bodies.size(); ++i)
    {
        const double t = 1.0 + i;
        m.host.bodies.orientation[i] = exp_rotation(Vec3{std::sin(t), std::sin(2 * t), std::sin(3 * t)});
        m.host.bodies.angular_velocity[i] = Vec3{std::cos(t), std::cos(2 * t), std::cos(5 * t)};
        m.host.bodies.velocity[i] = Vec3{std::cos(3 * t), std::cos(7 * t), 0};
    }
}

void chain(Mechanism& m, int n, double mass, double last)
{
    Ref before = kWorld;
    for (int i = 0; i < n; ++i)
    {
        const double kg = i == n - 1 ? last : mass;
        const Ref link = m.body(kg, Vec3{.01, .02, .02} * kg, {.5 + i, 0, 0});
        i % 2 == 0 ? m.ball(before, link, {double(i), 0, 0}) : m.hinge(before, link, {double(i), 0, 0}, {0, 1, 0});
        before = link;
    }
}

}  // namespace

TEST_CASE("chains and trees: accelerations are those of the whole matrix")
{
    Mechanism m;
    chain(m, 8, 1, 3);
    const Ref hub{Facet::Body, 3};
    for (int i = 0; i < 4; ++i) m.hinge(hub, m.body(1 + i, {1, 2, 2.5}, {3, 1.0 + i, 0}), {3, double(i), 0}, {1, 0, 0});
    stir(m);
    m.build();
    CHECK(worst_difference(m) < 1e-13);
}

TEST_CASE("loops: accelerations are those of the whole matrix")
{
    Mechanism m;
    chain(m, 6, 1, 1);
    m.ball(kWorld, {Facet::Body, 5}, {6, 0, 0});
    m.ball({Facet::Body, 0}, {Facet::Body, 3}, {1, 2, 1});
    stir(m);
    m.build();
    CHECK(worst_difference(m) < 1e-12);
}

TEST_CASE("mass ratios to 1e8: heavy bodies keep their digits, light ones those that the ratio leaves")
{
    for (const double last : {1e8, 1e-8})
        for (const bool looped : {false, true})
        {
            CAPTURE(last);
            CAPTURE(looped);
            Mechanism m;
            chain(m, 6, 1, last);
            if (looped) m.ball(kWorld, {Facet::Body, 2}, {3, 1, 1});
            stir(m);
            m.build();
            // Two forces of 1e9 N on a link of 1 kg: their difference has seven digits, whatever the method.
            CHECK(worst_difference(m, 5) < 1e-11);
            CHECK(worst_difference(m) < 1e-7);
        }
}

TEST_CASE("duplicated rows: the same motion, the load shared equally, the copies counted")
{
    Mechanism once, twice;
    for (Mechanism* m : {&once, &twice})
    {
        const Ref rod = m->body(2, {.1, .1, .1}, {.5, 0, 0});
        m->hinge(kWorld, rod, {0, 0, 0}, {0, 1, 0});
        if (m == &twice) m->hinge(kWorld, rod, {0, 0, 0}, {0, 1, 0});
        m->build();
        m->run(1, 1e-3);
    }
    CHECK(length(once.host.bodies.position[0] - twice.host.bodies.position[0]) < 1e-12);
    CHECK(once.report.redundant == 0);
    CHECK(twice.report.redundant == 5);
    CHECK(twice.report.contradictory.empty());
    simulation::RowReportTable a, b;
    a.clear(1), b.clear(2);
    once.rows.report_to(a), twice.rows.report_to(b);
    for (const std::uint32_t copy : {0u, 1u}) CHECK(length(b.of(copy).force - 0.5 * a.of(0).force) < 1e-4 * length(a.of(0).force));
}

TEST_CASE("pins too far apart converge to the least-squares position, are named, and have bounded energy")
{
    Mechanism m;
    const Ref rod = m.body(1, {.1, .3, .3}, {0, 0, 0});
    m.ball(kWorld, {-1, 0, 0}, rod, {-.9, 0, 0});
    m.ball(kWorld, {1, 0, 0}, rod, {.9, 0, 0});
    m.build();
    m.run(1, 1e-2);
    CHECK(m.report.contradictory == std::vector<std::uint32_t>{0, 1});
    CHECK_FALSE(m.report.converged);
    CHECK(std::fabs(m.report.position_error - .1) < 1e-6);
    CHECK(length(m.host.bodies.position[0]) < 1e-6);
    CHECK(std::fabs(m.energy()) < 1e-5);
}

namespace
{

/// A rod of 1 m without mass between the origin of `b` and a point of the world.
void rod_to(Mechanism& m, const Vec3& from, Ref b)
{
    m.add(
        [=](const Bodies& bodies, const Shafts&, RowSink& sink)
        {
            const Vec3 d = bodies.position[b.index] - from, v = bodies.velocity[b.index];
            const double length_now = length(d), rate = dot(d, v) / length_now;
            ConstraintRow row;
            row.count = 1;
            row.blocks[0] = {b, d * (1 / length_now), {}};
            row.error = length_now - 1;
            row.bias = -(length_squared(v) - rate * rate) / length_now;
            sink.add(row);
        });
}

}  // namespace

TEST_CASE("two rods too short pull the body to the middle, whatever the last digits of its position are")
{
    // The sum of the squares of the errors is least at (1.5, 0, 0), where each rod lacks 0.5 m. To first order nothing holds the body
    // there in y and z: an undamped Newton step from z is of length 1/z.
    for (const double z : {0.0, 1e-15, -3e-12, 1e-9, 2e-6, 1e-3, -0.1, 0.7, 5.0})
        for (const double x : {1.0, 1.0 + 1e-15, 0.3, 2.9})
        {
            CAPTURE(z);
            CAPTURE(x);
            Mechanism m;
            const Ref body = m.body(1, {.1, .1, .1}, {x, 0.5 * z, z});
            rod_to(m, {0, 0, 0}, body), rod_to(m, {3, 0, 0}, body);
            m.build();
            const auto report = m.rows.project(StepContext{});
            CHECK_FALSE(report.converged);
            CHECK(report.contradictory == std::vector<std::uint32_t>{0, 1});
            CHECK(std::fabs(report.position_error - .5) < 1e-9);
            CHECK(length(m.host.bodies.position[0] - Vec3{1.5, 0, 0}) < 1e-5);
        }
}

TEST_CASE("a body that hangs from one between rods too short keeps its joint exactly")
{
    Mechanism m;
    const Ref body = m.body(1, {.1, .1, .1}, {1, 0, 1e-3}), bob = m.body(2, {.1, .1, .1}, {1.2, 0.1, -1});
    rod_to(m, {0, 0, 0}, body), rod_to(m, {3, 0, 0}, body);
    m.ball(body, {0, 0, 0}, bob, {0, 0, 1});
    m.build();
    const auto report = m.rows.project(StepContext{});
    CHECK(report.contradictory == std::vector<std::uint32_t>{0, 1});
    CHECK(std::fabs(report.position_error - .5) < 1e-6);
    const Bodies& b = m.host.bodies;
    CHECK(length(b.position[1] + rotate(b.orientation[1], Vec3{0, 0, 1}) - b.position[0]) < 1e-14);
}

TEST_CASE("a body placed far from its joint is brought back, also after a rotation of nearly half a turn")
{
    Mechanism m;
    const Ref rod = m.body(1, {.1, .1, .1}, {.5, 0, 0});
    m.hinge(kWorld, rod, {0, 0, 0}, {0, 1, 0});
    m.build();
    m.host.bodies.position[0] = {4, 5, -6};
    m.host.bodies.orientation[0] = exp_rotation(Vec3{3.1, 0, 0});  // its axis nearly reversed
    m.host.bodies.velocity[0] = {1, 2, 3};
    const auto report = m.rows.project(StepContext{});
    CHECK(report.converged);
    CHECK(report.position_error < 1e-14);
    CHECK(report.speed_error < 1e-14);
    CHECK(std::fabs(rotate(m.host.bodies.orientation[0], Vec3{0, 1, 0}).y - 1) < 1e-14);
}

TEST_CASE("speeds that are matched conserve momentum, and the energy lost is booked")
{
    Mechanism m;
    const Ref a = m.body(2, {1, 1, 1}, {0, 0, 0}), b = m.body(3, {1, 1, 1}, {2, 0, 0});
    m.gravity = {};
    m.ball(a, b, {1, 0, 0});
    m.host.bodies.velocity[0] = {1, 2, 0};
    m.build();
    const double before = m.energy();
    std::vector<double> work(1, 0.0);
    const auto report = m.rows.project_speeds(StepContext{}, {&work, 1, {}, {}});
    CHECK(report.speed_error < 1e-15);
    CHECK(length(2 * m.host.bodies.velocity[0] + 3 * m.host.bodies.velocity[1] - Vec3{2, 4, 0}) < 1e-14);
    CHECK(m.energy() < before);
    CHECK(std::fabs(m.energy() - before - work[0]) < 1e-14);
}

TEST_CASE("a chain stretched out between two pins stays there, at any step")
{
    // Five links of 1 m between pins 5 m apart: to first order it could sag, but it cannot.
    for (const double h : {1e-4, 1e-3, 1. / 60})
    {
        CAPTURE(h);
        Mechanism m;
        Ref before = kWorld;
        for (int i = 0; i < 5; ++i)
        {
            const Ref link = m.body(1, {.1, .1, .1}, {.5 + i, 0, 0});
            m.hinge(before, link, {double(i), 0, 0}, {0, 1, 0});
            before = link;
        }
        m.ball(kWorld, before, {5, 0, 0});
        m.build();
        for (int i = 0; i < 1000; ++i)
        {
            m.step(h);
            REQUIRE(m.report.position_error < 1e-6);
            REQUIRE(std::fabs(m.host.bodies.position[2].z) < 1e-3);
            REQUIRE(std::fabs(m.energy()) < 5);
        }
    }
}
