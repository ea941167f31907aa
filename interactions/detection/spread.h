/// Reduces many contact points to the few that matter.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "contact_points.h"

namespace plab::detection
{

/// Keeps the deepest point, and the outermost one in each of 8 directions across the normal: these resist tilting in every
/// direction.
class Spread
{
public:
    /// Points with a gap of up to `margin` (m) are considered.
    Spread(const Vec3& normal, double margin) : t1_(any_perpendicular(normal)), t2_(cross(normal, t1_)), margin_(margin) {}

    void offer(const ContactPoint& contact_point)
    {
        constexpr double kDiagonal = 0.70710678118654752;
        constexpr std::array<std::array<double, 2>, 4> kAxes{{{1, 0}, {kDiagonal, kDiagonal}, {0, 1}, {-kDiagonal, kDiagonal}}};
        if (!(contact_point.depth > -margin_)) return;
        const double x = dot(t1_, contact_point.point), y = dot(t2_, contact_point.point);
        for (std::size_t k = 0; k < kAxes.size(); ++k)
        {
            const double along = kAxes[k][0] * x + kAxes[k][1] * y;
            keep(2 * k, along, contact_point);
            keep(2 * k + 1, -along, contact_point);
        }
        keep(kDeepest, contact_point.depth, contact_point);
        any_ = true;
    }
    double deepest() const { return any_ ? best_[kDeepest].value : -HUGE_VAL; }
    /// Adds the kept points, each feature once, ordered by feature.
    void take(ContactPoints& out)
    {
        if (!any_) return;
        std::sort(best_.begin(), best_.end(),
                  [](const Best& a, const Best& b) { return a.contact_point.feature < b.contact_point.feature; });
        for (std::size_t i = 0; i < best_.size(); ++i)
            if (i == 0 || best_[i].contact_point.feature != best_[i - 1].contact_point.feature) out.add(best_[i].contact_point);
    }

private:
    static constexpr std::size_t kDeepest = 8;
    struct Best
    {
        double value = 0;
        ContactPoint contact_point;
    };
    void keep(std::size_t k, double value, const ContactPoint& contact_point)
    {
        if (!any_ || value > best_[k].value) best_[k] = {value, contact_point};
    }

    Vec3 t1_, t2_;
    double margin_;
    bool any_ = false;
    std::array<Best, 9> best_{};
};

}  // namespace plab::detection
