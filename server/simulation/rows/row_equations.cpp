#include "simulation/rows/row_equations.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plab::simulation
{
namespace
{

constexpr int kMostRefinements = 6;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
/// Refinement cannot improve a residual below this share of the largest terms of a sum.
constexpr double kResidualFloor = 4 * kEpsilon;
constexpr double kIdleShare = 1e-6;
/// At rest the relative residual of rows is 1 but for rounding, however small their errors are.
constexpr double kSameLeft = 1.01;
/// A relative residual below this needs no further treatment (sharpen()).
constexpr double kSettled = 1e-14;
/// Relative tolerance for comparing x . M x of two solutions: rounding and the remaining residual.
constexpr double kSameSpeed = 1e-3;

}  // namespace

void RowEquations::weigh(Member& m) const
{
    if (m.participant.facet == Facet::Body)
    {
        m.inverse_mass = host_->bodies.inverse_mass[m.participant.index];
        return;
    }
    const ShaftTree* tree = graph_->tree_of(m.participant.index);
    m.inertia = tree ? tree->inertia : host_->shafts.inertia[m.participant.index];
}

void RowEquations::fill(Slot& slot, const ConstraintRow& row)
{
    Entry* entries = &entries_[slot.first_entry];
    for (std::uint32_t e = 0; e < slot.entries; ++e) entries[e].j.fill(0);
    std::uint32_t next = 0;
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        if (!pattern_[slot.held].participants[k].mobile) continue;
        // Blocks on the same member share one entry, for example two shafts of one train.
        std::uint32_t e = 0;
        while (e < next && members_[entries[e].member].participant != row.blocks[k].participant) ++e;
        if (e == next) ++next;
        std::array<double, 6>& j = entries[e].j;
        const RowBlock& block = row.blocks[k];
        if (block.participant.facet == Facet::Shaft)
        {
            j[0] += block.angular.x;
            continue;
        }
        const Vec3 angular_B = rotate_back(host_->bodies.orientation[block.participant.index], block.angular);
        j[0] += block.linear.x, j[1] += block.linear.y, j[2] += block.linear.z;
        j[3] += angular_B.x, j[4] += angular_B.y, j[5] += angular_B.z;
    }
    slot.mobility = 0;
    if (joints_[slot.joint].compliant)
        for (std::uint32_t e = 0; e < slot.entries; ++e) slot.mobility += mobility_of(entries[e]);
}

double RowEquations::mobility_of(const Entry& entry) const
{
    const Member& m = members_[entry.member];
    const auto& j = entry.j;
    if (m.participant.facet == Facet::Shaft) return j[0] * j[0] / m.inertia;
    const Vec3 angular{j[3], j[4], j[5]};
    return (j[0] * j[0] + j[1] * j[1] + j[2] * j[2]) * m.inverse_mass +
           dot(angular, host_->bodies.inverse_inertia_B[m.participant.index] * angular);
}

void RowEquations::fill_masses()
{
    for (std::uint32_t i = 0; i < members_.size(); ++i)
    {
        double* d = factors_.diagonal(i);
        const Member& m = members_[i];
        if (m.participant.facet == Facet::Shaft)
        {
            d[0] = m.inertia;
            continue;
        }
        const double mass = host_->bodies.mass[m.participant.index];
        const Mat3& inertia = host_->bodies.inertia_B[m.participant.index];
        for (int r = 0; r < 3; ++r) d[r * 7] = mass;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c <= r; ++c) d[(3 + r) * 6 + 3 + c] = inertia(r, c);
    }
}

void RowEquations::factor(double implied, double others)
{
    compliance_ = implied;
    factors_.clear();
    fill_masses();
    const auto first_joint = static_cast<std::uint32_t>(members_.size());
    for (std::size_t s = 0; s < slots_.size(); ++s)
    {
        const Slot& slot = slots_[s];
        const Joint& joint = joints_[slot.joint];
        const double compliance = implied_.empty() || implied_[s] != 0 ? implied : others;
        for (std::uint32_t e = slot.first_entry; e < slot.first_entry + slot.entries; ++e)
        {
            const Entry& entry = entries_[e];
            const std::uint32_t columns = size_of(members_[entry.member]);
            for (std::uint32_t c = 0; c < columns; ++c) factors_.add(entry.edge, slot.place, c, entry.j[c]);
        }
        // A row that can move nothing (a train geared to itself) gets a compliance of 1: its multiplier then has no effect.
        const double soft = !joint.compliant ? 0.0 : slot.mobility > 0 ? compliance * slot.mobility : 1.0;
        factors_.diagonal(first_joint + slot.joint)[slot.place * (joint.rows + 1)] = -soft;
        factors_.set_floor(unknown_of(slot), 0.1 * soft, soft);
    }
    (void)factors_.factor();
    const auto small = factors_.small();
    any_small_ = std::find(small.begin(), small.end(), std::uint8_t{1}) != small.end();
}

void RowEquations::clear_right_hand_side() { std::fill(rhs_.begin(), rhs_.end(), 0.0); }

double RowEquations::moved(std::size_t s) const
{
    const Slot& slot = slots_[s];
    double sum = 0;
    for (std::uint32_t e = slot.first_entry; e < slot.first_entry + slot.entries; ++e)
    {
        const double* x = result(entries_[e].member);
        const std::uint32_t columns = size_of(members_[entries_[e].member]);
        for (std::uint32_t c = 0; c < columns; ++c) sum += entries_[e].j[c] * x[c];
    }
    return sum;
}

/// Subtracts J^T y from the residuals of the members, and computes the residuals of the rows. The scale of each residual is the sum of
/// the magnitudes of its terms.
void RowEquations::subtract_rows()
{
    std::fill(joint_error_.begin(), joint_error_.end(), 0.0);
    std::fill(joint_scale_.begin(), joint_scale_.end(), 0.0);
    for (const Slot& slot : slots_)
    {
        const std::uint32_t u = unknown_of(slot);
        double sum = rhs_[u], scale = std::fabs(rhs_[u]);
        for (std::uint32_t e = slot.first_entry; e < slot.first_entry + slot.entries; ++e)
        {
            const Entry& entry = entries_[e];
            const std::uint32_t at = factors_.offset(entry.member), columns = size_of(members_[entry.member]);
            for (std::uint32_t c = 0; c < columns; ++c)
            {
                const double term = entry.j[c] * x_[at + c], pull = entry.j[c] * x_[u];
                sum -= term, scale += std::fabs(term);
                r_[at + c] -= pull, scale_[at + c] += std::fabs(pull);
            }
        }
        r_[u] = sum;
        joint_error_[slot.joint] = std::fmax(joint_error_[slot.joint], std::fabs(sum));
        joint_scale_[slot.joint] = std::fmax(joint_scale_[slot.joint], scale);
    }
}

double RowEquations::worst_of_rows() const
{
    // A joint without load has no scale of its own; a small share of the largest scale is used instead.
    double busiest = 0, worst = 0;
    for (const double scale : joint_scale_) busiest = std::fmax(busiest, scale);
    for (std::size_t j = 0; j < joints_.size(); ++j)
    {
        const double scale = std::fmax(joint_scale_[j], kIdleShare * busiest);
        if (scale > 0) worst = std::fmax(worst, joint_error_[j] / scale);
    }
    return worst;
}

double RowEquations::worst_of_members() const
{
    double worst = 0;
    for (std::uint32_t i = 0; i < members_.size(); ++i)
    {
        // Per 3-vector rather than per component, because a component that is not loaded has no scale of its own.
        const std::uint32_t u = factors_.offset(i), n = size_of(members_[i]);
        for (std::uint32_t c = 0; c < n; c += 3)
        {
            double error = 0, scale = 0;
            for (std::uint32_t k = u + c; k < u + std::min(n, c + 3); ++k)
                error = std::fmax(error, std::fabs(r_[k])), scale = std::fmax(scale, scale_[k]);
            if (scale > 0) worst = std::fmax(worst, error / scale);
        }
    }
    return worst;
}

void RowEquations::times_mass(const Member& m, const double* x, double* out) const
{
    if (m.participant.facet == Facet::Shaft)
    {
        out[0] = m.inertia * x[0];
        return;
    }
    const double mass = host_->bodies.mass[m.participant.index];
    const Vec3 spin = host_->bodies.inertia_B[m.participant.index] * Vec3{x[3], x[4], x[5]};
    out[0] = mass * x[0], out[1] = mass * x[1], out[2] = mass * x[2], out[3] = spin.x, out[4] = spin.y, out[5] = spin.z;
}

void RowEquations::over_mass(const Member& m, const double* g, double* out) const
{
    if (m.participant.facet == Facet::Shaft)
    {
        out[0] = g[0] / m.inertia;
        return;
    }
    const Vec3 spin = host_->bodies.inverse_inertia_B[m.participant.index] * Vec3{g[3], g[4], g[5]};
    out[0] = m.inverse_mass * g[0], out[1] = m.inverse_mass * g[1], out[2] = m.inverse_mass * g[2];
    out[3] = spin.x, out[4] = spin.y, out[5] = spin.z;
}

RowEquations::Norms RowEquations::norms() const
{
    double loads = 0, reactions = 0;
    for (std::uint32_t i = 0; i < members_.size(); ++i)
    {
        const std::uint32_t u = factors_.offset(i);
        double mx[6], free[6];
        times_mass(members_[i], &x_[u], mx);
        over_mass(members_[i], &rhs_[u], free);
        for (std::uint32_t c = 0; c < size_of(members_[i]); ++c)
            loads += rhs_[u + c] * free[c], reactions += (mx[c] - rhs_[u + c]) * (x_[u + c] - free[c]);
    }
    return {std::sqrt(loads), std::sqrt(std::fmax(0.0, reactions))};
}

/// r = rhs - K x with C = 0. Returns the largest element relative to the size of its terms.
double RowEquations::residual()
{
    for (std::uint32_t i = 0; i < members_.size(); ++i)
    {
        const std::uint32_t u = factors_.offset(i);
        double mx[6];
        times_mass(members_[i], &x_[u], mx);
        for (std::uint32_t c = 0; c < size_of(members_[i]); ++c)
            r_[u + c] = rhs_[u + c] - mx[c], scale_[u + c] = std::fabs(rhs_[u + c]) + std::fabs(mx[c]);
    }
    subtract_rows();
    return std::fmax(worst_of_rows(), worst_of_members());
}

bool RowEquations::is_finite() const
{
    return std::all_of(x_.begin(), x_.end(), [](double v) { return std::isfinite(v); });
}

bool RowEquations::solve()
{
    std::copy(rhs_.begin(), rhs_.end(), x_.begin());
    factors_.solve(x_);
    return is_finite();
}

/// Sets joint_load_.
void RowEquations::find_joint_loads()
{
    std::fill(joint_load_.begin(), joint_load_.end(), 0.0);
    for (const Slot& slot : slots_)
    {
        double sum = 0;
        for (std::uint32_t e = slot.first_entry; e < slot.first_entry + slot.entries; ++e)
        {
            const Entry& entry = entries_[e];
            double free[6];
            over_mass(members_[entry.member], &rhs_[factors_.offset(entry.member)], free);
            for (std::uint32_t c = 0; c < size_of(members_[entry.member]); ++c) sum += std::fabs(entry.j[c] * free[c]);
        }
        joint_load_[slot.joint] = std::fmax(joint_load_[slot.joint], sum);
    }
}

/// The residuals of the rows, relative to what they have to stop. Of members at rest all terms of a residual are as small as the residual.
double RowEquations::worst_of_loads() const
{
    double largest = 0, worst = 0;
    for (const double load : joint_load_) largest = std::fmax(largest, load);
    for (std::size_t j = 0; j < joints_.size(); ++j)
        if (largest > 0) worst = std::fmax(worst, joint_error_[j] / std::fmax(joint_load_[j], kIdleShare * largest));
    return worst;
}

bool RowEquations::solve_refined()
{
    if (!solve()) return false;
    if (!any_compliant_ && !any_small_) return true;
    find_joint_loads();
    double left = residual(), left_of_loads = worst_of_loads();
    for (int i = 0; i < kMostRefinements && left > kResidualFloor; ++i)
    {
        const double before = left, before_of_loads = left_of_loads;
        std::copy(x_.begin(), x_.end(), before_.begin());
        factors_.solve(r_);
        for (std::size_t u = 0; u < x_.size(); ++u) x_[u] += r_[u];
        left = residual(), left_of_loads = worst_of_loads();
        if (left < 0.5 * before ||
            (left <= kSameLeft * before && before_of_loads > kResidualFloor && left_of_loads < 0.5 * before_of_loads))
            continue;
        if (!(left <= before)) std::copy(before_.begin(), before_.end(), x_.begin());
        break;
    }
    return is_finite();
}

void RowEquations::note_implied()
{
    forget_implied();
    factor(kSharpCompliance);
    const auto small = factors_.small();
    const auto pivots = factors_.pivots();
    implied_.assign(slots_.size(), 0);
    for (std::size_t s = 0; s < slots_.size(); ++s)
    {
        const std::uint32_t u = unknown_of(slots_[s]);
        const bool compliant = joints_[slots_[s].joint].compliant;
        implied_[s] = small[u] != 0 || (compliant && !(pivots[u] > 10 * kSharpCompliance * slots_[s].mobility)) ? 1 : 0;
    }
}

bool RowEquations::rank_fell() const
{
    for (std::size_t s = 0; s < implied_.size(); ++s)
        if (implied_[s] == 0 && redundant(s)) return true;
    return false;
}

/// x . M x summed over the members.
double RowEquations::speed_of_result() const
{
    double sum = 0;
    for (std::uint32_t i = 0; i < members_.size(); ++i)
    {
        const double* x = result(i);
        double mx[6];
        times_mass(members_[i], x, mx);
        for (std::uint32_t c = 0; c < size_of(members_[i]); ++c) sum += mx[c] * x[c];
    }
    return sum;
}

void RowEquations::sharpen()
{
    if (!rank_fell()) return;
    const double left = residual();
    if (!(left > kSettled)) return;
    const double most = (1 + kSameSpeed) * speed_of_result();
    std::copy(x_.begin(), x_.end(), blunt_.begin());
    factor(kCompliance, kSharpCompliance);
    if (solve_refined() && speed_of_result() <= most && residual() < left) return;
    std::copy(blunt_.begin(), blunt_.end(), x_.begin());
}

bool RowEquations::redundant(std::size_t s) const
{
    const Slot& slot = slots_[s];
    const std::uint32_t u = unknown_of(slot);
    return factors_.small()[u] != 0 || (joints_[slot.joint].compliant && !(factors_.pivots()[u] > kRedundant * slot.mobility));
}

}  // namespace plab::simulation
