/// What contacts did in a step: their points, with the impulses that the bodies took there. Filled only if somebody asks for it before the
/// step.
///
/// It follows the ledger: the impulses of an advance are noted when its work is booked, and taken back when that is. So after a step, with
/// all that was rewound in it, the impulses on a body and those of the forces on it add up to the change of its momentum.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "plab/collision.h"

namespace plab::simulation
{

/// A contact point in a part of a step, or an impact.
struct LoggedContact
{
    std::uint32_t detector = kNoIndex;  ///< component
    Ref a, b;
    std::uint32_t feature = 0;
    Vec3 point, normal;         ///< W; m, unit, from a to b: where its impulse acts
    double depth = 0;           ///< m; < 0: a gap
    Vec3 impulse;               ///< N s on b, W
    double begin = 0, end = 0;  ///< s since the start of the step: when it acts
    bool is_impact = false;     ///< the bodies meet here

    friend bool is_same_point(const LoggedContact& x, const LoggedContact& y)
    {
        return x.detector == y.detector && x.a == y.a && x.b == y.b && x.feature == y.feature;
    }
};

class ContactLog
{
public:
    /// From the next step on.
    void keep(bool on) { wanted_ = on; }
    void begin_step() { on_ = wanted_, entries_.clear(), sleeping_ = {}; }
    /// Whether this step is logged.
    bool on() const { return on_; }

    /// A contact whose impulse acts from `begin` to `end` (s since the start of the step). Points that neither touch nor push are left out.
    void add(const Contact& c, std::uint32_t detector, double depth, double begin, double end, bool is_impact)
    {
        if (c.impulse == Vec3{} && !(depth >= 0)) return;
        entries_.push_back({detector, c.a, c.b, c.feature, c.point, c.normal, depth, c.impulse, begin, end, is_impact});
    }
    /// Drops what acts after `from` on bodies for which is_of(Ref) is true.
    template <class IsOf>
    void take_back(double from, IsOf is_of)
    {
        std::erase_if(entries_, [&](const LoggedContact& e) { return e.end > from && (is_of(e.a) || is_of(e.b)); });
    }
    /// The contacts of islands that sleep are kept elsewhere.
    void show_sleeping(std::span<const LoggedContact> contacts) { sleeping_ = contacts; }

    std::span<const LoggedContact> entries() const { return entries_; }
    /// Valid until the next step: with the impulses of the last step before their islands fell asleep.
    std::span<const LoggedContact> sleeping() const { return sleeping_; }

private:
    bool wanted_ = false, on_ = false;
    std::vector<LoggedContact> entries_;  ///< keeps its memory
    std::span<const LoggedContact> sleeping_;
};

}  // namespace plab::simulation
