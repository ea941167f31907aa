#include "rotation_splitting.h"

#include <array>
#include <bit>
#include <span>
#include <string>

#include "plab/free_rotation.h"
#include "plab/rotation.h"

namespace plab::solvers
{
namespace
{

/// The rotation of one body within the step, in its principal frame P.
struct Spinning
{
    Quat turn;        ///< P now -> P at the start
    Vec3 m;           ///< angular momentum in P now, N m s
    Vec3 reciprocal;  ///< 1 / I_i
    Mat3 axes;        ///< R_BP
};
constexpr std::size_t kNumbers = sizeof(Spinning) / sizeof(double);
using Numbers = std::array<double, kNumbers>;
static_assert(kNumbers <= 24);

/// Compositions by half steps, the first half of the palindrome.
constexpr std::array<double, 1> kOrder2{0.5};
// a_1 .. a_6 from the coefficients (a, b) of S6 as a splitting method: a_1 = a1, a_2 = b1 - a_1, a_3 = a2 - a_2, ...
constexpr double kA1 = 0.0792036964311957, kA2 = 0.353172906049774, kA3 = -0.0420650803577195;
constexpr double kB1 = 0.209515106613362, kB2 = -0.143851773179818;
constexpr double kC1 = kA1, kC2 = kB1 - kC1, kC3 = kA2 - kC2, kC4 = kB2 - kC3, kC5 = kA3 - kC4;
constexpr std::array<double, 6> kOrder4{kC1, kC2, kC3, kC4, kC5, 0.5 - kC1 - kC2 - kC3 - kC4 - kC5};

/// The whole free rotation in closed form. Splitting is not possible for needles: the rotation about the long axis would be driven by a
/// remainder of the momentum, which the other rotations have displaced, divided by a tiny moment of inertia.
void turn_freely(Spinning& body, double time)
{
    PrincipalAxes principal;
    principal.axes = Mat3::identity(), principal.reciprocal = body.reciprocal;
    principal.moment = {1 / body.reciprocal.x, 1 / body.reciprocal.y, 1 / body.reciprocal.z};
    const FreeTop top(principal, body.m);
    body.turn = body.turn * top.turn(time);
    body.m = top.momentum(time);
}

/// Computes sin and cos of half an angle, and from them the rotation of a vector; small angles of a step need no library call.
void turn_about(Spinning& body, int axis, double time)
{
    const double angle = time * body.reciprocal[axis] * body.m[axis];
    Vec3 v;
    v[axis] = angle;
    const Quat q = exp_rotation(v);
    const double c = q.w, s = axis == 0 ? q.x : (axis == 1 ? q.y : q.z);
    const double cosine_lack = 2 * s * s, sine = 2 * s * c;
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    const double mj = body.m[j], mk = body.m[k];
    body.m[j] = mj + (sine * mk - cosine_lack * mj);
    body.m[k] = mk - (sine * mj + cosine_lack * mk);
    body.turn = body.turn * q;
}

class Splitting
{
public:
    Splitting(double h, DynamicSystem& system) : h_(h), system_(system), x_(system.coordinates()), u_(system.speeds())
    {
        for (std::size_t i = 0; i < system_.body_count(); ++i) store(i, at_start(i));
    }

    void run(std::span<const double> half)
    {
        const std::size_t n = 2 * half.size();
        const auto a = [&](std::size_t i) { return h_ * (i < half.size() ? half[i] : half[n - 1 - i]); };
        const bool uniform = system_.forces_are_uniform();
        for (std::size_t i = 0; i < n; i += 2)
        {
            fly(a(i), false);
            if (!uniform) kick(a(i) + a(i + 1));
            // At the middle of the palindrome, where the flight has length zero: the middle of the step.
            if (uniform && half.size() == 1) kick(h_);
            fly(a(i + 1), true);
            if (uniform && half.size() > 1 && i + 2 == half.size()) kick(h_);
        }
        place_rotations();
    }

private:
    Spinning load(std::size_t body) const
    {
        Numbers numbers;
        for (std::size_t k = 0; k < kNumbers; ++k) numbers[k] = system_.workspace(static_cast<int>(k / 6))[6 * body + k % 6];
        return std::bit_cast<Spinning>(numbers);
    }
    void store(std::size_t body, const Spinning& spinning)
    {
        const Numbers numbers = std::bit_cast<Numbers>(spinning);
        for (std::size_t k = 0; k < kNumbers; ++k) system_.workspace(static_cast<int>(k / 6))[6 * body + k % 6] = numbers[k];
    }
    Vec3 vector(std::span<const double> from, std::size_t at) const { return {from[at], from[at + 1], from[at + 2]}; }
    void place(std::span<double> to, std::size_t at, const Vec3& v) { to[at] = v.x, to[at + 1] = v.y, to[at + 2] = v.z; }

    Spinning at_start(std::size_t i) const
    {
        const RigidMember member = system_.rigid(i);
        const PrincipalAxes principal = ascending(principal_axes(member));
        Spinning out;
        out.reciprocal = principal.reciprocal, out.axes = principal.axes;
        const Vec3 s = vector(u_, 6 * i + 3);
        if (member.needle)
        {
            const Vec3 w = transposed_times(out.axes, s);
            out.m = {w.x * principal.moment.x, w.y * principal.moment.y, w.z * principal.moment.z};
        }
        else
            out.m = transposed_times(out.axes, rotate_back(member.orientation, s));
        return out;
    }

    /// The flows A, B, C over `time`, or C, B, A.
    void fly(double time, bool reversed)
    {
        const std::size_t bodies = system_.body_count();
        for (std::size_t i = 0; i < bodies; ++i)
        {
            Spinning body = load(i);
            if (system_.rigid(i).needle)
                turn_freely(body, time);
            else
                for (int k = 0; k < 3; ++k) turn_about(body, reversed ? 2 - k : k, time);
            store(i, body);
            for (std::size_t k = 6 * i; k < 6 * i + 3; ++k) x_[k] += time * u_[k];
        }
        const std::size_t places = x_.size() - system_.quantity_count();
        for (std::size_t k = 6 * bodies; k < places; ++k) x_[k] += time * u_[k];
        time_ += time;
    }

    /// Writes the rotation vectors of the present attitudes, and the spins of needles.
    void place_rotations()
    {
        for (std::size_t i = 0; i < system_.body_count(); ++i)
        {
            const Spinning body = load(i);
            place(x_, 6 * i + 3, body.axes * log_rotation(body.turn));
            if (system_.rigid(i).needle)
                place(u_, 6 * i + 3,
                      body.axes * Vec3{body.m.x * body.reciprocal.x, body.m.y * body.reciprocal.y, body.m.z * body.reciprocal.z});
        }
    }

    /// The speed rates of the kick. Those of needles include their free rotation, which belongs to the flight and is removed.
    void forces(double weight, std::span<double> out)
    {
        system_.evaluate(time_, weight);
        const auto du = system_.speed_rates();
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = du[k];
        for (std::size_t i = 0; i < system_.body_count(); ++i)
        {
            const RigidMember member = system_.rigid(i);
            if (!member.needle) continue;
            const Vec3 w = vector(u_, 6 * i + 3);
            place(out, 6 * i + 3, vector(out, 6 * i + 3) + member.inverse_inertia_B * cross(w, member.inertia_B * w));
        }
    }

    void kick(double time)
    {
        place_rotations();
        const auto start = system_.workspace(4), k1 = system_.workspace(5), k2 = system_.workspace(6), sum = system_.workspace(7);
        const std::size_t n = u_.size();
        const double share = time / h_;
        for (std::size_t k = 0; k < n; ++k) start[k] = u_[k];
        const auto go = [&](double by, std::span<const double> rate)
        {
            for (std::size_t k = 0; k < n; ++k) u_[k] = start[k] + by * rate[k];
        };
        if (!depends_on_speed_)
        {
            forces(0, k1);
            go(0.5 * time, k1);
            forces(share, k2);  // with the mean speed: books the kinetic energy that the kick gives
            bool same = true;
            for (std::size_t k = 0; k < n; ++k) same = same && k1[k] == k2[k];
            if (same) return go(time, k1), take_momenta(start);
            forces(-share, k2);  // cancels the booking
            depends_on_speed_ = true;
            go(0, k1);
        }
        forces(share / 6, k1);
        for (std::size_t k = 0; k < n; ++k) sum[k] = k1[k];
        const auto stage = [&](double by, double weight, double factor)
        {
            go(by, k1);
            forces(share * weight, k1);
            for (std::size_t k = 0; k < n; ++k) sum[k] += factor * k1[k];
        };
        stage(0.5 * time, 1.0 / 3, 2), stage(0.5 * time, 1.0 / 3, 2), stage(time, 1.0 / 6, 1);
        go(time / 6, sum);
        take_momenta(start);
    }

    /// The momenta in P after a kick that started from the speeds `before`.
    void take_momenta(std::span<const double> before)
    {
        for (std::size_t i = 0; i < system_.body_count(); ++i)
        {
            const Vec3 change = vector(u_, 6 * i + 3) - vector(before, 6 * i + 3);
            if (change == Vec3{}) continue;
            const RigidMember member = system_.rigid(i);
            Spinning body = load(i);
            if (member.needle)
            {
                const Vec3 w = transposed_times(body.axes, change);
                body.m += Vec3{w.x / body.reciprocal.x, w.y / body.reciprocal.y, w.z / body.reciprocal.z};
            }
            else
                body.m += rotate_back(body.turn, transposed_times(body.axes, rotate_back(member.orientation, change)));
            store(i, body);
        }
    }

    double h_;
    DynamicSystem& system_;
    std::span<double> x_, u_;
    double time_ = 0;
    bool depends_on_speed_ = false;
};

}  // namespace

void RotationSplittingRows::describe(Schema& schema)
{
    schema.param(order, "order", unit::one, "2 (one kick) or 4 (six kicks)").or_else(4).at_least(2).at_most(4);
}

Result<void> prepare_rotation_splitting(const StepContext&, Row row, const RotationSplittingRows& rows)
{
    const std::int64_t order = rows.order[row];
    if (order == 2 || order == 4) return {};
    return reason("order is " + std::to_string(order) + "; this method has the orders 2 and 4");
}

void advance_by_splitting(double h, int order, DynamicSystem& system)
{
    Splitting splitting(h, system);
    if (order == 4)
        splitting.run(kOrder4);
    else
        splitting.run(kOrder2);
}

void advance_rotation_splitting(const StepContext& context, Row row, const RotationSplittingRows& rows, DynamicSystem& system)
{
    advance_by_splitting(context.dt, static_cast<int>(rows.order[row]), system);
}

}  // namespace plab::solvers
