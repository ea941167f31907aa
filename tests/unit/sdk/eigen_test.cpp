// Eigen's views: the same numbers, wherever they are stored; and why eigenvalues are not computed by Eigen.
#include "plab/eigen.h"

#include <doctest/doctest.h>
#include <Eigen/Eigenvalues>

#include "plab/registrar.h"
#include "plab/symmetric.h"
#include "unit/objects/table.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// A plugin's table.
struct WindRows
{
    Column<double> speed;
    Column<Vec3> direction;
};

// The example of server/docs/interactions.md.
struct LayeredDragRows
{
    Column<RefList> between;
    Column<Mat3> coefficient;  ///< N s/m, in W

    void describe(Schema& schema)
    {
        schema.role(between, "between", {Facet::Body}, "bodies that are slowed down").writes().independent();
        schema.param(coefficient, "coefficient", unit::one, "force against speed, in N s/m");
    }
};

void apply_layered_drag(const StepContext& context, Rows rows, const LayeredDragRows& drag, const Bodies& bodies, Wrenches& wrenches)
{
    for (const Row row : rows)
    {
        wrenches.begin(context.component_of_row[row]);
        for (const Ref body : drag.between[row])
            wrenches.add_force(body, from_eigen(-as_eigen(drag.coefficient[row]) * as_eigen(bodies.velocity[body.index])));
    }
}

Vec3 momentum(const Bodies& bodies) { return from_eigen(as_eigen(bodies.velocity) * as_eigen(bodies.mass)); }

}  // namespace

TEST_CASE("a plugin's force written in Eigen")
{
    Bodies bodies = make_bodies(2);
    Shafts shafts = make_shafts(0);
    Wrenches wrenches{bodies, shafts};
    wrenches.force.resize(2);
    bodies.velocity = {{1, 2, 3}, {0, 0, 1}}, bodies.mass = {2, 3};
    TableFixture<LayeredDragRows> drag;
    drag.rows.between[0] = {{Facet::Body, 0}};
    drag.rows.coefficient[0] = {{{1, 0, 0}, {0, 1, 0}, {0, 0.5, 10}}};
    constexpr Row rows[] = {0};
    apply_layered_drag(drag.context(), rows, drag.rows, bodies, wrenches);
    CHECK(wrenches.force[0] == Vec3{-1, -2, -31});
    CHECK(momentum(bodies) == Vec3{2, 4, 9});
}

TEST_CASE("views of vectors, matrices and quaternions are the same numbers")
{
    Vec3 v{1, 2, 3};
    Mat3 a{{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}};
    Quat q{0.5, 0.1, 0.2, 0.3};
    CHECK(as_eigen(v).data() == &v.x);
    CHECK(as_eigen(a).data() == &a.m[0][0]);
    CHECK(as_eigen(q).data() == &q.w);
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) CHECK(&as_eigen(a)(r, c) == &a(r, c));
    as_eigen(v) *= 2;
    CHECK(v == Vec3{2, 4, 6});
    as_eigen(a).transposeInPlace();
    CHECK(a(0, 2) == 7);
    as_eigen(q).w() = 4;  // the fourth number, which is z: w comes first
    CHECK(q == Quat{0.5, 0.1, 0.2, 4});
    const Vec3 product = from_eigen(as_eigen(a) * as_eigen(v));
    CHECK(product == a * v);
    CHECK(from_eigen(as_eigen(a) * as_eigen(a)) == a * a);

    const Vec3 fixed{1, 2, 3};
    static_assert(std::is_same_v<decltype(as_eigen(fixed)), Eigen::Map<const Eigen::Vector3d>>, "what is const stays so");
}

TEST_CASE("views of host tables: a column for each element, nothing between them")
{
    Bodies bodies;
    bodies.position = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    bodies.orientation.resize(3), bodies.inertia_B.resize(3);
    bodies.mass = {1, 2, 3};
    auto places = as_eigen(bodies.position);
    static_assert(decltype(places)::RowsAtCompileTime == 3);
    CHECK(places.cols() == 3);
    CHECK(places.data() == &bodies.position[0].x);
    for (std::uint32_t i = 0; i < 3; ++i)
    {
        CHECK(&places(0, i) == &bodies.position[i].x);
        CHECK(&places(2, i) == &bodies.position[i].z);
        CHECK(&as_eigen(bodies.orientation)(3, i) == &bodies.orientation[i].z);
        CHECK(&as_eigen(bodies.inertia_B)(5, i) == &bodies.inertia_B[i].m[1][2]);
        CHECK(&as_eigen(bodies.mass)[i] == &bodies.mass[i]);
    }
    // The centre of mass of all.
    const Vec3 centre = from_eigen(places * as_eigen(bodies.mass) / as_eigen(bodies.mass).sum());
    CHECK(centre == Vec3{5, 6, 7});
    places.colwise() += Eigen::Vector3d(0, 0, 1);
    CHECK(bodies.position[2] == Vec3{7, 8, 10});

    const Bodies none;
    CHECK(as_eigen(none.position).size() == 0);
    CHECK(as_eigen(none.mass).size() == 0);
}

TEST_CASE("views of a plugin's columns and of parts of a list")
{
    WindRows rows;
    rows.speed.resize(5), rows.direction.resize(5);
    for (Row row = 0; row < 5; ++row) rows.speed[row] = row, rows.direction[row] = {0, 1.0 * row, 0};
    as_eigen(rows.direction).row(2) = as_eigen(rows.speed).transpose();
    for (Row row = 0; row < 5; ++row)
    {
        CHECK(&as_eigen(rows.speed)[row] == &rows.speed[row]);
        CHECK(&as_eigen(rows.direction)(1, row) == &rows.direction[row].y);
        CHECK(rows.direction[row] == Vec3{0, 1.0 * row, 1.0 * row});
    }
    const WindRows& seen = rows;
    CHECK(as_eigen(seen.speed).data() == &seen.speed[0]);
    rows.speed.resize(0);
    CHECK(as_eigen(rows.speed).size() == 0);

    std::vector<double> list{1, 2, 3, 4, 5, 6, 7};
    const auto part = as_eigen(std::span(list).subspan(1, 5));
    CHECK(part.data() == &list[1]);
    CHECK(part.size() == 5);
    CHECK(part.dot(part) == 90);
}

TEST_CASE("views need no alignment beyond that of a double")
{
    // Sums over a view and products of it have the same bits for any address modulo 32.
    std::vector<double> room(64);
    double first = 0;
    for (std::size_t at = 0; at < 8; ++at)
    {
        const std::span<double> list(room.data() + at, 41);
        for (std::size_t i = 0; i < list.size(); ++i) list[i] = std::sin(static_cast<double>(i));
        const double dot = as_eigen(list).dot(as_eigen(list));
        if (at == 0) first = dot;
        CHECK(dot == first);
    }
    static_assert(alignof(Vec3) == alignof(double) && alignof(Mat3) == alignof(double) && alignof(Quat) == alignof(double));
    struct Packed
    {
        double before;
        Mat3 a;
        Vec3 v;
    } packed{0, Mat3::diagonal(2, 3, 4), {1, 1, 1}};
    CHECK(from_eigen(as_eigen(packed.a) * as_eigen(packed.v)) == Vec3{2, 3, 4});
}

TEST_CASE("eigenvalues of a graded matrix keep their digits; Eigen's solver loses the smallest one completely")
{
    // D B D with D = diag(1e-4, 1e-8, 1) and B = 1 + (1 1 1)^T (1 1 1): the product of the eigenvalues is det(B) det(D)^2 = 4e-24.
    const Mat3 a{{{2e-8, 1e-12, 1e-4}, {1e-12, 2e-16, 1e-8}, {1e-4, 1e-8, 2}}};
    const SymmetricAxes ours = symmetric_axes(a);
    CHECK(std::fabs(ours.values.x * ours.values.y * ours.values.z / 4e-24 - 1) < 1e-14);
    const Eigen::Vector3d theirs = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(as_eigen(a)).eigenvalues();
    CHECK(theirs.minCoeff() < 0);  // should be 1.3e-16
    const Mat3 &R = ours.axes, back = R * Mat3::diagonal(ours.values.x, ours.values.y, ours.values.z) * transposed(R);
    CHECK((as_eigen(back) - as_eigen(a)).cwiseAbs().maxCoeff() < 1e-15);
    CHECK(determinant(R) == doctest::Approx(1).epsilon(1e-15));
}
