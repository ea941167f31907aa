/// What touched each body in a step, for commands of phase Finish: contact points with their impulses, impacts inside the step, and what
/// components add.
#pragma once

#include <cstdint>
#include <vector>

#include "simulation/contacts/contact_book.h"

namespace plab::simulation
{

/// Collected once at the end of a step, in a pass over its contacts, and only in scenes with a command that asks for it.
class BodyTouches final : public Touches
{
public:
    BodyTouches(StepState& step, ContactBook& contacts) : step_(step), contacts_(contacts) {}

    /// To be called after any structural change.
    void rebuild();
    bool wanted() const { return wanted_; }
    /// The touches of the step that ends; nothing has been added to them.
    void collect();
    std::span<const TouchPoint> of(Ref body) const override;
    void add(Ref body, const TouchPoint& point) override { added_.push_back({body.index, point}); }

private:
    struct Entry
    {
        std::uint32_t body = 0;
        TouchPoint point;
    };
    void add_pair(Ref a, Ref b, const Vec3& point, const Vec3& normal, const Vec3& impulse, bool persists);
    void collect_contacts();
    void collect_impacts();
    void sort_by_body();

    StepState& step_;
    ContactBook& contacts_;
    bool wanted_ = false;
    // Lists keep their memory.
    std::vector<Entry> found_, added_;
    std::vector<std::uint32_t> begin_, place_;  ///< by body, and one more: where its entries begin in sorted_
    std::vector<TouchPoint> sorted_;
    mutable std::vector<TouchPoint> asked_;
};

}  // namespace plab::simulation
