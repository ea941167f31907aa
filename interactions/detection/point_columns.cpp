#include "point_columns.h"

#include "plab/lanes.h"

namespace plab::detection
{
namespace
{
using lanes::Lanes;

template <class Mask>
PLAB_INLINE Lanes<4> chosen(const Mask& mask, const Lanes<4>& yes, const Lanes<4>& no)
{
    return mask ? yes : no;
}
}  // namespace

PointColumns::PointColumns(std::span<const Vec3> points)
{
    const std::size_t count = (points.size() + kWidth - 1) / kWidth * kWidth;
    for (std::size_t i = 0; i < count; ++i)
    {
        const Vec3& p = i < points.size() ? points[i] : points.front();
        x_.push_back(p.x), y_.push_back(p.y), z_.push_back(p.z);
    }
}

PointColumns::Furthest PointColumns::furthest(const Vec3& d) const
{
    Furthest out;
    const auto search = PLAB_LANES
    {
        const auto all = [](double v) { return Lanes<4>{v, v, v, v}; };
        const Lanes<4> dx = all(d.x), dy = all(d.y), dz = all(d.z);
        Lanes<4> most = all(-HUGE_VAL), index = all(0), at{0, 1, 2, 3};
        for (std::size_t i = 0; i < x_.size(); i += kWidth)
        {
            const Lanes<4> along = dx * lanes::load(&x_[i]) + dy * lanes::load(&y_[i]) + dz * lanes::load(&z_[i]);
            const auto larger = along > most;
            most = chosen(larger, along, most), index = chosen(larger, at, index);
            at += all(4);
        }
        out = {static_cast<std::size_t>(lanes::lane(index, 0)), lanes::lane(most, 0)};
        for (int k = 1; k < 4; ++k)
        {
            const auto other = static_cast<std::size_t>(lanes::lane(index, k));
            const double along = lanes::lane(most, k);
            if (along > out.along || (along == out.along && other < out.index)) out = {other, along};
        }
    };
    lanes::run_lanes<4>(search);
    return out;
}

}  // namespace plab::detection
