/// Free rotation in closed form, and Solver/Exact with it: machine precision at any step, for every kind of top.
#include "plab/free_rotation.h"
#include "objects/solvers/exact.h"
#include "objects/solvers/fixed_step.h"
#include "plab/elliptic.h"
#include "unit/solvers/problems.h"

using namespace plab;
using namespace plab::solvers;
using namespace plab::test;

namespace
{

RigidMember member(const Vec3& I)
{
    RigidMember out;
    out.inertia_B = diagonal(I), out.inverse_inertia_B = Mat3::diagonal(1 / I.x, 1 / I.y, 1 / I.z);
    return out;
}
Vec3 times(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// Spin and attitude of a free top at a time. References: Taylor series of order 40 of Euler's equations, 40 digits.
struct Top
{
    Vec3 inertia, spin;
    double time;
    Vec3 spin_then;
    Quat turn_then;
};
const Top kTops[] = {
    {{1, 2, 3},
     {0.01, 5, 0.01},
     20,
     {0.015715217678814917436, 4.9999853031717310702, 0.012206119594866296976},
     {-0.70956269522612850873, -0.00067118913482409107111, -0.70463737430775219746, -0.0025498582812157004799}},
    {{3, 2, 1},
     {1e-6, 10, 1e-6},
     5,
     {0.000049098566815711124062, -9.9999999996385496105, 0.000085029452486009509564},
     {4.2891478908330581941e-6, -0.61022138374595696094, -5.3703974595637017196e-7, 0.79223094032010914159}},
    {{2, 1, 3},
     {-4, 0.5, 1},
     7,
     {-1.7267549558756327812, 3.6425701533888048766, 2.3107226374995724475},
     {0.90960120931544941224, -0.044185315961143638399, -0.29629903352505622081, 0.28788918110516675053}},
    {{1, 2, 2.999},
     {0.1, -0.2, -6},
     9,
     {0.020620525739004667308, 0.22266473925477135998, -5.9997336725848480193},
     {-0.30275827097705288654, 0.010305970572334122248, 0.0018682261567846128465, -0.95300982474294288078}},
    {{2, 2, 3.5},
     {1, 0.5, 8},
     6,
     {0.36792573709415318739, -1.0557606982568180773, 8.0},
     {0.53883008046294967215, -0.070924392291016568354, 0.028815153274934554943, -0.83892881814143397561}},
    {{1.00000000000001, 1, 1},
     {3, 2, 1},
     6,
     {3.0, 1.99999999999982, 1.00000000000036},
     {0.22739121118167470457, -0.78077979032394274245, -0.52051986021591955623, -0.2602599301080183366}},
    {{1, 3, 2},
     {50, 1, 20},
     1,
     {53.685230229478308892, -11.329959470243654825, 4.2303729395773561711},
     {-0.8507539234611118991, -0.17540161619664708702, 0.31120940633405697094, -0.38548766538027191169}},
};

}  // namespace

TEST_CASE("Jacobi's functions are correct to rounding, from the circle to close to the separatrix")
{
    struct Sample
    {
        double complement, u, sn, cn, dn;
    };
    // Thirty digits, mpmath.
    for (const Sample& s : {Sample{0.7, 0.04, 0.039986137845722384888, 0.99920023457772611153, 0.99976013755002998039},
                            {0.7, 0.15, 0.14927207947564859598, 0.98879616013059822621, 0.99665207263453011632},
                            {0.7, 1.3, 0.93965113130832248284, 0.3421341132231477725, 0.85738948292435737682},
                            {0.7, 7.7, 0.73010523464622978996, 0.68333472496440113192, 0.91656091117974921081},
                            {2e-8, 9.3, 0.99999998790934256736, 0.00015550342349641241932, 0.00021019351615946267269},
                            {2e-8, 0.19, 0.18774620589050264298, 0.98221757374510510775, 0.98221757410397302828},
                            {1, 2.5, 0.59847214410395649405, -0.80114361554693371483, 1.0}})
    {
        CAPTURE(s.u);
        const JacobiValues v = EllipticModulus(s.complement).at(s.u);
        CHECK(std::fabs(v.sn - s.sn) < 2e-15);
        CHECK(std::fabs(v.cn - s.cn) < 2e-15);
        CHECK(std::fabs(v.dn - s.dn) < 2e-15);
        CHECK(EllipticModulus(s.complement).at(-s.u).sn == -v.sn);
    }
    CHECK(EllipticModulus(0).at(1.5).sn == doctest::Approx(std::tanh(1.5)).epsilon(1e-15));
}

TEST_CASE("one step of any length rotates a top according to Euler's equations")
{
    for (const Top& top : kTops)
    {
        CAPTURE(top.inertia.x);
        CAPTURE(top.inertia.z);
        const PrincipalAxes body = principal_axes(member(top.inertia));
        const FreeTop free(body, times(top.inertia, top.spin));
        // Rounding at the start grows like any disturbance of the motion: by e^25 for the second one, near its unstable axis.
        const double unstable = top.spin.y == 10 ? 1e5 : (top.spin.y == 5 ? 1e2 : 1);
        CHECK(length(times(body.reciprocal, free.momentum(top.time)) - top.spin_then) < 1e-13 * length(top.spin) * unstable);
        CHECK(attitude_error(free.turn(top.time), top.turn_then) < 2e-14 * unstable * std::fmax(1, length(top.spin) * top.time / 10));
        // Back in time, and in pieces.
        CHECK(attitude_error(free.turn(-0.3) * FreeTop(body, free.momentum(-0.3)).turn(0.3), Quat{}) < 1e-14);
        Quat q;
        Vec3 m = times(top.inertia, top.spin);
        for (int i = 0; i < 50; ++i)
        {
            const FreeTop piece(body, m);
            q = q * piece.turn(top.time / 50), m = piece.momentum(top.time / 50);
        }
        CHECK(attitude_error(q, top.turn_then) < 1e-13 * unstable * std::fmax(1, length(top.spin) * top.time / 10));
    }
}

TEST_CASE("the box of reference problem A2, at steps from 1 ms to 100 s")
{
    for (const auto& [h, steps] : {std::pair{0.001, 5000}, {0.01, 500}, {1.0 / 30, 150}, {0.5, 10}, {5.0, 1}})
    {
        Solver<ExactRows> exact(advance_exact);
        Body box(diagonal(kBoxInertia), kBoxSpin);
        const Vec3 L = box.momentum();
        box.run(h, steps, std::ref(exact));
        CAPTURE(h);
        CHECK(attitude_error(box.orientation, kBoxAt5) < 2e-12);
        CHECK(length(box.spin_B() - kBoxSpinAt5) < 2e-12);
        CHECK(box.momentum() == L);
        CHECK(exact.rows.resolved.resolved[0] == "Exact");
        CHECK(exact.events.all.empty());
    }
    Solver<ExactRows> exact(advance_exact);
    Body box(diagonal(kBoxInertia), kBoxSpin);
    box.run(100, 1, std::ref(exact));
    CHECK(attitude_error(box.orientation, kBoxAt100) < 5e-14);
    CHECK(length(box.spin_B() - kBoxSpinAt100) < 1e-13);
}

TEST_CASE("rounding errors do not add up in one direction")
{
    Solver<ExactRows> exact(advance_exact);
    Body box(diagonal(kBoxInertia), kBoxSpin);
    const double energy = box.spin_energy();
    box.run(0.001, 200000, std::ref(exact));
    CHECK(std::fabs(box.spin_energy() / energy - 1) < 1e-12);
}

TEST_CASE("an unstable spin flips on time, whatever the step")
{
    for (const int steps : {1, 10, 1000})
    {
        Solver<ExactRows> exact(advance_exact);
        Body wing(Mat3::diagonal(3, 2, 1), {1e-3, 10, 1e-3});
        wing.run(10.0 / steps, steps, std::ref(exact));
        CHECK(length(wing.spin_B() - Vec3{9.1429206965016778e-3, -9.9999876110424964, 1.5772729522424334e-2}) < 5e-8);
    }
    // The flip comes later by (2/5.77) ln 10 s per decade of the initial offset; one step finds it at 1e-12 as well.
    const PrincipalAxes body = principal_axes(member({3, 2, 1}));
    double before = 0;
    for (const double offset : {1e-3, 1e-6, 1e-9, 1e-12})
    {
        const FreeTop top(body, {3 * offset, 20, offset});
        double late = 0;
        while (top.momentum(late).y > 0) late += 0.1;
        double early = late - 0.1;
        while (late - early > 1e-12) (top.momentum(0.5 * (early + late)).y > 0 ? early : late) = 0.5 * (early + late);
        if (before > 0) CHECK(early - before == doctest::Approx(std::log(1e3) / (10 * std::sqrt(1.0 / 3))).epsilon(1e-5));
        before = early;
    }
}

TEST_CASE("degenerate tops: ball, disc, rod, needle, rest, and the unstable axis itself")
{
    const auto after = [](const Mat3& inertia, const Vec3& w, double h, int steps, bool needle)
    {
        Solver<ExactRows> exact(advance_exact);
        Body b(inertia, w, {}, needle);
        b.run(h, steps, std::ref(exact));
        return b;
    };
    const Body ball = after(Mat3::diagonal(0.4, 0.4, 0.4), {1, 2, 3}, 1, 100, false);
    CHECK(length(ball.spin_B() - Vec3{1, 2, 3}) < 1e-13);
    CHECK(length(rotate(ball.orientation, {1, 2, 3}) - Vec3{1, 2, 3}) < 1e-12);
    for (const bool needle : {false, true})
        for (const auto& [i3, w3] : {std::pair{2.0, 5.0}, {1e-4, 5.0}, {1e-12, 1e3}})
        {
            if (!needle && i3 == 1e-12) continue;
            const Body top = after(Mat3::diagonal(1, 1, i3), {0.1, 0, w3}, 0.1, 10, needle);
            const double rate = (i3 - 1) * w3;
            CHECK(std::hypot(top.spin_B().x - 0.1 * std::cos(rate), top.spin_B().y - 0.1 * std::sin(rate)) < 1e-11);
            CHECK(top.spin_B().z == doctest::Approx(w3).epsilon(1e-12));
        }
    const Body still = after(Mat3::diagonal(1, 2, 3), {0, 0, 0}, 1, 10, false);
    CHECK(still.orientation == Quat{});
    const Body middle = after(Mat3::diagonal(1, 2, 3), {0, 4, 0}, 0.25, 1, false);
    CHECK(attitude_error(middle.orientation, exp_rotation({0, 1, 0})) < 1e-15);
    const Body tiny = after(Mat3::diagonal(1e-200, 2e-200, 3e-200), {1, 2, 3}, 1, 1, false);
    const Body usual = after(Mat3::diagonal(1, 2, 3), {1, 2, 3}, 1, 1, false);
    CHECK(attitude_error(tiny.orientation, usual.orientation) < 1e-14);
}

TEST_CASE("a body in a frame that is not principal rotates in the same way")
{
    const Quat tilt = exp_rotation({0.3, -1.1, 0.7});
    const Mat3 R = rotation_matrix(tilt);
    Solver<ExactRows> exact(advance_exact);
    Body straight(diagonal(kBoxInertia), kBoxSpin), tilted(R * diagonal(kBoxInertia) * transposed(R), R * kBoxSpin);
    tilted.turn_to(conjugate(tilt));
    straight.run(0.7, 20, std::ref(exact)), tilted.run(0.7, 20, std::ref(exact));
    CHECK(attitude_error(tilted.orientation * tilt, straight.orientation) < 3e-13);
}

TEST_CASE("the parabola is exact, and so is the ledger")
{
    for (const int per_second : {1, 60, 960})
    {
        Solver<ExactRows> exact(advance_exact);
        Body b(diagonal(kBoxInertia), kBoxSpin);
        b.gravity = {0, 0, -9.81}, b.position = {0, 0, 10}, b.set_velocity({5, 0, 10});
        b.run(1.0 / per_second, 2 * per_second, std::ref(exact));
        CHECK(length(b.position - Vec3{10, 0, 30 - 0.5 * 9.81 * 4}) < 1e-12);
        CHECK(b.work == doctest::Approx(-9.81 * (b.position.z - 10)).epsilon(1e-12));
        CHECK(b.evaluations == 4 * per_second);
    }
}

TEST_CASE("motion without a closed form is advanced by a documented method, which is reported once")
{
    const auto drag = [](double, const Body& b) { return Body::Load{-0.1 * b.velocity(), {}}; };
    Solver<ExactRows> exact(advance_exact);
    Body b(diagonal(kBoxInertia), kBoxSpin, drag);
    b.set_velocity({1, 0, 0});
    b.run(0.01, 100, std::ref(exact));
    CHECK(exact.rows.resolved.resolved[0] == "RotationSplitting");
    CHECK(exact.events.count("solver.fell_back") == 1);
    CHECK(b.velocity().x == doctest::Approx(std::exp(-0.1)).epsilon(1e-11));

    // A promise of uniform forces that does not hold is noticed, and books only once.
    Body liar(diagonal(kBoxInertia), kBoxSpin, drag);
    liar.uniform = true, liar.set_velocity({1, 0, 0});
    liar.run(0.01, 1, std::ref(exact));
    CHECK(exact.rows.resolved.resolved[0] == "RotationSplitting");
    CHECK(liar.booked == doctest::Approx(1).epsilon(1e-12));

    Body held(diagonal(kBoxInertia), kBoxSpin), reference(diagonal(kBoxInertia), kBoxSpin);
    held.constrained = true;
    held.run(0.01, 10, std::ref(exact));
    reference.run(0.01, 10,
                  [](double h, DynamicSystem& s)
                  {
                      StepContext c;
                      c.dt = h;
                      advance_runge_kutta4(c, 0, {}, s);
                  });
    CHECK(exact.rows.resolved.resolved[0] == "RungeKutta4");
    CHECK(held.orientation == reference.orientation);
    CHECK(exact.events.count("solver.fell_back") == 2);

    exact.trial = true, exact.rows.resolved.resolved[0] = "untouched";
    held.run(0.01, 1, std::ref(exact));
    CHECK(exact.rows.resolved.resolved[0] == "untouched");
}

TEST_CASE("a slow turn by its series: order 5 against the closed form, and exact to rounding where it is used")
{
    // Axes that are not principal: I = R diag R^T.
    const Quat tilt = exp_rotation({0.3, -0.5, 0.8});
    const Mat3 R = rotation_matrix(tilt);
    for (const Vec3& moments : {Vec3{1, 2, 2.9}, Vec3{0.1, 1, 1.05}, Vec3{2, 2, 3}})
    {
        CAPTURE(moments.x);
        RigidMember body;
        body.inertia_B = R * diagonal(moments) * transposed(R);
        body.inverse_inertia_B = R * Mat3::diagonal(1 / moments.x, 1 / moments.y, 1 / moments.z) * transposed(R);
        const PrincipalAxes axes = principal_axes(body);
        const Vec3 m{0.31, -0.22, 0.41};
        const auto error = [&](double t)
        {
            const Quat turned_P = FreeTop(axes, transposed_times(axes.axes, m)).turn(t);
            const Vec3 v = axes.axes * Vec3{turned_P.x, turned_P.y, turned_P.z};
            const Quat turned{turned_P.w, v.x, v.y, v.z};
            return length(log_rotation(conjugate(turned) * slow_turn(body.inverse_inertia_B, m, t)));
        };
        CHECK(std::log2(error(0.08) / error(0.04)) == doctest::Approx(5).epsilon(0.06));
        const double slow = 0x1p-11 / (length(m) * (1 / moments.x + 1 / moments.y + 1 / moments.z));
        CHECK(turns_slowly(body.inverse_inertia_B, m, 0.999 * slow));
        CHECK_FALSE(turns_slowly(body.inverse_inertia_B, m, 1.001 * slow));
        CHECK(error(slow) < 2e-16);
        CHECK(error(8 * slow) < 1e-14);
    }
}
