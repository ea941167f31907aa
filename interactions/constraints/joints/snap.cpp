#include "joints/snap.h"

#include <array>
#include <numbers>

#include "plab/rotation.h"

namespace plab::constraints
{

void SnapRows::describe(Schema& s)
{
    s.role(a, "a", {Facet::Body}, "to which b is drawn; none: the world").optional().writes();
    s.role(b, "b", {Facet::Body}, "which is drawn to a").writes();
    s.param(point_a, "point_a", unit::metre, "origin of the frame on a, in the frame of a (of the world, if there is no a)").or_else({});
    s.param(point_b, "point_b", unit::metre, "origin of the frame on b, in the frame of b").or_else({});
    s.param(frame_a, "frame_a", unit::one, "turns the axes of the frame on a into those of a").or_else({});
    s.param(frame_b, "frame_b", unit::one, "turns the axes of the frame on b into those of b").or_else({});
    s.param(frequency, "frequency", unit::one, "w / 2 pi, Hz").or_else(2).positive();
    s.param(turns, "turns", unit::one, "all axes are turned into one another, not only the lines of the z axes").or_else(false);
    s.output(distance, "distance", unit::metre, "between the two origins");
    s.output(angle, "angle", unit::radian, "by which the axes differ").reported_as_error();
}

namespace
{

constexpr std::size_t kMostRows = 6;

/// The rows of one pair.
class Gathered final : public RowSink
{
public:
    void begin(std::uint32_t) override {}
    void add(const ConstraintRow& row) override { rows[count++] = row; }

    std::array<ConstraintRow, kMostRows> rows;
    std::size_t count = 0;
};

Gathered rows_of(const SnapRows& snaps, Row row, const Bodies& bodies)
{
    const Sides s = sides_of(side_of(bodies, snaps.a[row], snaps.point_a[row]), side_of(bodies, snaps.b[row], snaps.point_b[row]));
    const Quat frame_a = s.a.q * snaps.frame_a[row], frame_b = s.b.q * snaps.frame_b[row];
    Gathered out;
    const Vec3 axes[] = {rotate(frame_a, {1, 0, 0}), rotate(frame_a, {0, 1, 0}), rotate(frame_a, {0, 0, 1})};
    for (const Vec3& t : axes) out.add(travel_row(s, t, 0, 0));
    if (snaps.turns[row])
    {
        const Vec3 turned = log_rotation(frame_b * conjugate(frame_a));
        for (const Vec3& e : axes) out.add(turn_row(s, e, dot(e, turned), true, 0));
        return out;
    }
    // The line of b's axis has no direction: it is turned by the smaller angle.
    const Vec3 z_b = rotate(frame_b, {0, 0, 1});
    add_axis_rows(s, axes[2], dot(axes[2], z_b) < 0 ? -z_b : z_b, axes[0], axes[1], 0, out);
    return out;
}

/// J v.
double rate_of(const ConstraintRow& row, const Bodies& bodies)
{
    double rate = 0;
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const RowBlock& block = row.blocks[k];
        rate += dot(block.linear, bodies.velocity[block.participant.index]);
        rate += dot(block.angular, bodies.angular_velocity[block.participant.index]);
    }
    return rate;
}

/// One element of J M^-1 J^T.
double coupling_of(const ConstraintRow& one, const ConstraintRow& other, const Bodies& bodies)
{
    double sum = 0;
    for (std::uint32_t i = 0; i < one.count; ++i)
        for (std::uint32_t k = 0; k < other.count; ++k)
        {
            const RowBlock &x = one.blocks[i], &y = other.blocks[k];
            if (x.participant != y.participant) continue;
            const std::uint32_t body = x.participant.index;
            sum += bodies.inverse_mass[body] * dot(x.linear, y.linear) + dot(x.angular, bodies.inverse_inertia_W(body) * y.angular);
        }
    return sum;
}

/// Solves K x = b for a symmetric positive definite K by its Cholesky factor (Golub, Van Loan, Matrix computations, section 4.2). Rows that
/// the others imply get nothing.
void solve(std::array<std::array<double, kMostRows>, kMostRows>& k, std::array<double, kMostRows>& x, std::size_t n)
{
    for (std::size_t j = 0; j < n; ++j)
    {
        const double whole = k[j][j];
        for (std::size_t m = 0; m < j; ++m) k[j][j] -= k[j][m] * k[j][m];
        k[j][j] = k[j][j] > 1e-12 * whole ? std::sqrt(k[j][j]) : 0;
        for (std::size_t i = j + 1; i < n; ++i)
        {
            for (std::size_t m = 0; m < j; ++m) k[i][j] -= k[i][m] * k[j][m];
            k[i][j] = k[j][j] > 0 ? k[i][j] / k[j][j] : 0;
        }
    }
    for (std::size_t i = 0; i < n; ++i)
    {
        for (std::size_t m = 0; m < i; ++m) x[i] -= k[i][m] * x[m];
        x[i] = k[i][i] > 0 ? x[i] / k[i][i] : 0;
    }
    for (std::size_t i = n; i-- > 0;)
    {
        for (std::size_t m = i + 1; m < n; ++m) x[i] -= k[m][i] * x[m];
        x[i] = k[i][i] > 0 ? x[i] / k[i][i] : 0;
    }
}

/// e'' as it is wanted.
double wanted(const ConstraintRow& row, double w, const Bodies& bodies) { return -w * w * row.error - 2 * w * rate_of(row, bodies); }

double frequency_of(const SnapRows& rows, Row row) { return 2 * std::numbers::pi * rows.frequency[row]; }

}  // namespace

void constrain_snap(const StepContext& step, Rows which, const SnapRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        const Gathered gathered = rows_of(rows, row, bodies);
        sink.begin(step.component_of_row[row]);
        for (std::uint32_t i = 0; i < gathered.count; ++i)
        {
            ConstraintRow r = gathered.rows[i];
            r.kind = RowKind::Rate, r.feature = i;
            r.rate = rate_of(r, bodies);
            r.bias += wanted(r, frequency_of(rows, row), bodies);
            sink.add(r);
        }
    }
}

void draw_together(const StepContext& step, Rows which, const SnapRows& rows, const Bodies& bodies, Wrenches& wrenches)
{
    for (const Row row : which)
    {
        const bool acts = (rows.a[row].valid() && step.active(rows.a[row])) || step.active(rows.b[row]);
        if (!acts) continue;
        const Gathered gathered = rows_of(rows, row, bodies);
        const double w = frequency_of(rows, row);
        std::array<std::array<double, kMostRows>, kMostRows> k{};
        std::array<double, kMostRows> lambda{};
        for (std::size_t i = 0; i < gathered.count; ++i)
        {
            const ConstraintRow& r = gathered.rows[i];
            lambda[i] = r.bias + wanted(r, w, bodies);
            for (std::size_t j = 0; j <= i; ++j) k[i][j] = k[j][i] = coupling_of(r, gathered.rows[j], bodies);
        }
        solve(k, lambda, gathered.count);
        wrenches.begin(step.component_of_row[row]);
        for (std::size_t i = 0; i < gathered.count; ++i)
            for (std::uint32_t n = 0; n < gathered.rows[i].count; ++n)
            {
                const RowBlock& block = gathered.rows[i].blocks[n];
                wrenches.add_force(block.participant, lambda[i] * block.linear);
                wrenches.add_torque(block.participant, lambda[i] * block.angular);
            }
    }
}

void finish_snap(Rows which, SnapRows& rows, const Bodies& bodies)
{
    for (const Row row : which)
    {
        const Gathered gathered = rows_of(rows, row, bodies);
        double place = 0, turn = 0;
        for (std::size_t i = 0; i < gathered.count; ++i) (i < 3 ? place : turn) += gathered.rows[i].error * gathered.rows[i].error;
        rows.distance[row] = std::sqrt(place), rows.angle[row] = std::sqrt(turn);
    }
}

}  // namespace plab::constraints
