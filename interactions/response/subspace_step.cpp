#include "subspace_step.h"

#include <algorithm>
#include <cmath>

#include "plab/eigen.h"
// After plab/eigen.h.
#include <Eigen/Cholesky>

namespace plab::response
{
namespace
{

/// Friction up to this share of its bound sticks.
constexpr double kSticks = 1 - 1e-9;
/// Of the largest singular value: smaller ones count little by little as zero.
constexpr double kSingular = 0x1p-20;

/// The largest share of `change`, at most 1, with which an impulse stays in its cone.
double share_within(const ConeContact& c, const Vec3& change)
{
    const double pressing = c.impulse.z + change.z < 0 ? -c.impulse.z / change.z : 1.0;
    const Vec3 j = c.impulse, dj = change * pressing;
    // |j_t + s dj_t| = mu (j_n + s dj_n)
    const double mu = c.friction, a = dj.x * dj.x + dj.y * dj.y - mu * mu * dj.z * dj.z, b = j.x * dj.x + j.y * dj.y - mu * mu * j.z * dj.z,
                 d = j.x * j.x + j.y * j.y - mu * mu * j.z * j.z;
    const double normal = std::max(j.z, j.z + dj.z), slack = 1e-12 * mu * mu * normal * normal;
    if (a + 2 * b + d <= slack) return pressing;
    if (d > -slack) return b > 0 ? 0.0 : pressing;
    const double root = std::sqrt(std::max(0.0, b * b - a * d));
    return pressing * std::clamp(b > 0 ? -d / (b + root) : (root - b) / a, 0.0, 1.0);
}

/// An impulse that is on the surface of its cone but for rounding.
Vec3 on_cone(const Vec3& j, double friction)
{
    const double hold = std::hypot(j.x, j.y), most = friction * j.z;
    if (!(most > 0) || !(hold > 0)) return {};
    return {j.x * (most / hold), j.y * (most / hold), j.z};
}

}  // namespace

void SubspaceStep::reserve(std::size_t contacts)
{
    if (contacts < 2 || contacts > kMostContacts || contacts <= change_.capacity()) return;
    const std::size_t most = 3 * contacts;
    unknowns_.reserve(most), change_.reserve(contacts);
    matrix_.reserve(most * most), normal_.reserve(most * most);
    for (std::vector<double>* const v : {&aim_, &rest_, &present_, &solution_}) v->reserve(most);
}

void SubspaceStep::list_unknowns(std::span<const ConeContact> contacts)
{
    unknowns_.clear();
    for (std::uint32_t k = 0; k < contacts.size(); ++k)
    {
        const ConeContact& c = contacts[k];
        if (!(c.impulse.z > 0)) continue;
        const double hold = std::hypot(c.impulse.x, c.impulse.y), most = c.friction * c.impulse.z;
        if (hold < kSticks * most)
            unknowns_.push_back({k, {1, 0, 0}, {1, 0, 0}}), unknowns_.push_back({k, {0, 1, 0}, {0, 1, 0}}),
                unknowns_.push_back({k, {0, 0, 1}, {0, 0, 1}});
        else
            unknowns_.push_back({k, {c.impulse.x / c.impulse.z, c.impulse.y / c.impulse.z, 1}, {0, 0, 1}});
    }
}

/// The smallest impulses, or the smallest change, that solve the equations, A x = r, as x = A^T (A A^T + e^2)^-1 r, and the same with what
/// that leaves of r. Sets solution_ to the change.
void SubspaceStep::solve(std::span<const ConeContact> contacts, const ContactVelocities& velocities, Aim aimed)
{
    const auto n = static_cast<Eigen::Index>(unknowns_.size());
    const auto size = unknowns_.size();
    matrix_.resize(size * size), normal_.resize(size * size);
    aim_.resize(size), rest_.resize(size), present_.resize(size), solution_.resize(size);
    using Vector = Eigen::Map<Eigen::VectorXd>;
    Eigen::Map<Eigen::MatrixXd> A(matrix_.data(), n, n), N(normal_.data(), n, n);
    Vector aim(aim_.data(), n), r(rest_.data(), n), present(present_.data(), n), x(solution_.data(), n);
    for (Eigen::Index i = 0; i < n; ++i)
    {
        const Unknown& row = unknowns_[static_cast<std::size_t>(i)];
        const ConeContact& c = contacts[row.place];
        aim[i] = dot(row.direction, Vec3{0, 0, c.least} - velocities.at(c.contact));
        present[i] = dot(row.direction, c.impulse);
        for (Eigen::Index j = 0; j < n; ++j)
        {
            const Unknown& column = unknowns_[static_cast<std::size_t>(j)];
            A(i, j) = dot(row.direction, velocities.change(c.contact, contacts[column.place].contact, column.force));
        }
    }
    N.noalias() = A.lazyProduct(A.transpose());
    N.diagonal().array() += kSingular * kSingular * N.diagonal().maxCoeff();
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(N);
    if (aimed == Aim::Nearest) present.setZero();
    aim.noalias() += A.lazyProduct(present);
    r = aim, x.setZero();
    constexpr int kTimes = 3;
    for (int k = 0; k < kTimes; ++k)
    {
        if (k > 0) r = aim, r.noalias() -= A.lazyProduct(x);
        cholesky.solveInPlace(r);
        x.noalias() += A.transpose().lazyProduct(r);
    }
    x -= present;
}

void SubspaceStep::take(std::span<ConeContact> contacts, ContactVelocities& velocities)
{
    if (contacts.size() > kMostContacts) return;
    // An impulse that meets its cone slides or separates from then on.
    constexpr int kMostPieces = 8;
    for (int piece = 0; piece < kMostPieces; ++piece)
    {
        if (go(contacts, velocities, Aim::Smallest)) continue;
        // What rounding of whole impulses has left.
        (void)go(contacts, velocities, Aim::Nearest);
        return;
    }
}

/// One piece of the way. Returns whether an impulse has met its cone before the end.
bool SubspaceStep::go(std::span<ConeContact> contacts, ContactVelocities& velocities, Aim aimed)
{
    list_unknowns(contacts);
    if (unknowns_.empty()) return false;
    solve(contacts, velocities, aimed);
    change_.assign(contacts.size(), {});
    for (std::size_t i = 0; i < unknowns_.size(); ++i) change_[unknowns_[i].place] += unknowns_[i].force * solution_[i];
    double share = 1;
    std::size_t first = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k)
        if (change_[k] != Vec3{})
            if (const double own = share_within(contacts[k], change_[k]); own < share) share = own, first = k;
    if (!(share >= 0)) return false;  // NaN
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
        ConeContact& c = contacts[k];
        const Vec3 more = share < 1 && k == first ? on_cone(c.impulse + change_[k] * share, c.friction) - c.impulse : change_[k] * share;
        if (more == Vec3{}) continue;
        c.impulse += more;
        velocities.apply(c.contact, more, velocities.at(c.contact).z + (velocities.K(c.contact) * more).z);
    }
    return share < 1;
}

}  // namespace plab::response
