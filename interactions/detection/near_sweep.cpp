#include "near_sweep.h"

#include <algorithm>

namespace plab::detection
{

void NearSweep::reset(std::size_t parts)
{
    boxes_.assign(parts, {});
    asked_.assign(parts, 0);
    half_spaces_.clear();
    pairs_.reserve(parts);
    order_.clear();
    for (std::uint32_t i = 0; i < parts; ++i) order_.push_back(i);
}

void NearSweep::set_box(std::uint32_t part, const Vec3& lower, const Vec3& upper) { boxes_[part] = {lower, upper}; }

void NearSweep::set_half_space(std::uint32_t part, const Vec3& normal, double offset, double growth)
{
    const auto at = std::lower_bound(half_spaces_.begin(), half_spaces_.end(), part,
                                     [](const HalfSpace& h, std::uint32_t wanted) { return h.part < wanted; });
    if (at == half_spaces_.end() || at->part != part)
        half_spaces_.insert(at, {part, normal, offset, growth});
    else
        *at = {part, normal, offset, growth};
}

const NearSweep::HalfSpace* NearSweep::half_space(std::uint32_t part) const
{
    const auto at = std::lower_bound(half_spaces_.begin(), half_spaces_.end(), part,
                                     [](const HalfSpace& h, std::uint32_t wanted) { return h.part < wanted; });
    return at != half_spaces_.end() && at->part == part ? &*at : nullptr;
}

const std::vector<NearSweep::Pair>& NearSweep::find_all()
{
    pairs_.clear();
    // Bodies move little between two calls, and insertion sort sorts nearly sorted data in one pass.
    for (std::size_t i = 1; i < order_.size(); ++i)
    {
        const std::uint32_t moving = order_[i];
        std::size_t at = i;
        for (; at > 0 && boxes_[order_[at - 1]].lower.x > boxes_[moving].lower.x; --at) order_[at] = order_[at - 1];
        order_[at] = moving;
    }
    for (std::size_t i = 0; i < order_.size(); ++i)
    {
        const Box& a = boxes_[order_[i]];
        if (!bounded(order_[i])) continue;
        for (std::size_t j = i + 1; j < order_.size() && boxes_[order_[j]].lower.x <= a.upper.x; ++j)
            if (bounded(order_[j]) && overlap(a, boxes_[order_[j]])) pairs_.push_back(std::minmax(order_[i], order_[j]));
    }
    for (const HalfSpace& h : half_spaces_)
        for (std::uint32_t i = 0; i < boxes_.size(); ++i)
            if (bounded(i) && reaches(h.normal, h.offset, boxes_[i], h.growth)) pairs_.push_back(std::minmax(h.part, i));
    std::sort(pairs_.begin(), pairs_.end());
    return pairs_;
}

const std::vector<NearSweep::Pair>& NearSweep::find_of(std::span<const std::uint32_t> few)
{
    pairs_.clear();
    for (const std::uint32_t i : few) asked_[i] = 1;
    for (const std::uint32_t i : few)
    {
        if (const HalfSpace* h = half_space(i))
        {
            for (std::uint32_t j = 0; j < boxes_.size(); ++j)
                if (bounded(j) && reaches(h->normal, h->offset, boxes_[j], h->growth)) pairs_.push_back(std::minmax(i, j));
            continue;
        }
        if (!bounded(i)) continue;
        const Box a = boxes_[i];
        // If both parts of a pair are in `few`, the first one reports it.
        for (std::uint32_t j = 0; j < boxes_.size(); ++j)
            if (overlap(a, boxes_[j]) && bounded(j) && j != i && (asked_[j] == 0 || i < j)) pairs_.push_back(std::minmax(i, j));
        for (const HalfSpace& h : half_spaces_)
            if (asked_[h.part] == 0 && reaches(h.normal, h.offset, a, h.growth)) pairs_.push_back(std::minmax(i, h.part));
    }
    for (const std::uint32_t i : few) asked_[i] = 0;
    std::sort(pairs_.begin(), pairs_.end());
    return pairs_;
}

}  // namespace plab::detection
