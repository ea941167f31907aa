/// Reduces many contact points to the few that matter.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "contact_points.h"

namespace plab::detection
{

/// Keeps up to 9 points as they are. Of more it keeps the deepest, and the outermost one in each of 8 directions across the normal: these
/// resist tilting in every direction.
class Spread
{
public:
    /// Points with a gap of up to `margin` (m) are considered. Of two that are nearer than `same` (m) one is dropped, unless both are
    /// corners of the same solid: the moving point of a rim passes the fixed ones.
    Spread(const Vec3& normal, double margin, double same = 0)
        : t1_(any_perpendicular(normal)), t2_(cross(normal, t1_)), margin_(margin), same_(same)
    {
    }

    void offer(const ContactPoint& contact_point)
    {
        constexpr double kDiagonal = 0.70710678118654752;
        constexpr std::array<std::array<double, 2>, 4> kAxes{{{1, 0}, {kDiagonal, kDiagonal}, {0, 1}, {-kDiagonal, kDiagonal}}};
        if (!(contact_point.depth > -margin_)) return;
        if (count_ < first_.size()) first_[count_] = contact_point;
        ++count_;
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
        if (count_ <= first_.size()) return take_all(out);
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
    void take_all(ContactPoints& out)
    {
        const std::span<ContactPoint> all(first_.data(), count_);
        const auto key = [](const ContactPoint& p) { return std::tie(p.feature, p.point.x, p.point.y, p.point.z); };
        std::sort(all.begin(), all.end(), [&](const ContactPoint& a, const ContactPoint& b) { return key(a) < key(b); });
        for (std::size_t i = 0; i < all.size(); ++i)
        {
            const auto is_same = [&](const ContactPoint& other)
            {
                if (other.feature == all[i].feature) return true;
                return other.feature >> 18 != all[i].feature >> 18 && length_squared(other.point - all[i].point) < same_ * same_;
            };
            if (std::none_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(i), is_same)) out.add(all[i]);
        }
    }
    void keep(std::size_t k, double value, const ContactPoint& contact_point)
    {
        if (!any_ || value > best_[k].value) best_[k] = {value, contact_point};
    }

    Vec3 t1_, t2_;
    double margin_, same_;
    bool any_ = false;
    std::size_t count_ = 0;  // offered, of which the first are in first_
    std::array<ContactPoint, 9> first_{};
    std::array<Best, 9> best_{};
};

}  // namespace plab::detection
