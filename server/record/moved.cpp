#include "record/moved.h"

#include <cstddef>
#include <cstring>

namespace plab::record
{
namespace
{

// Compares raw bits: a state that changed from 0 to -0 has moved. Padding between members is not compared.
bool same(const wire::BodyState& a, const wire::BodyState& b)
{
    constexpr std::size_t kFrom = offsetof(wire::BodyState, position);
    const auto bytes = [](const wire::BodyState& s) { return reinterpret_cast<const char*>(&s) + kFrom; };
    return a.handle == b.handle && std::memcmp(bytes(a), bytes(b), sizeof a - kFrom) == 0;
}
bool same(const wire::ShaftState& a, const wire::ShaftState& b)
{
    return a.handle == b.handle && std::memcmp(&a.angle, &b.angle, sizeof a.angle) == 0 &&
           std::memcmp(&a.speed, &b.speed, sizeof a.speed) == 0;
}

/// Both are in the same order while the structure does not change, so compare place by place.
template <class State>
void keep_moved(const std::vector<State>& now, std::vector<State>& last, std::vector<State>& out)
{
    out.clear();
    for (std::size_t i = 0; i < now.size(); ++i)
    {
        if (same(now[i], last[i])) continue;
        out.push_back(now[i]);
        last[i] = now[i];
    }
}

}  // namespace

const wire::Frame& MovedFilter::thin(const wire::Frame& frame)
{
    const bool same_things = frame.run == last_.run && frame.revision == last_.revision && frame.bodies.size() == last_.bodies.size() &&
                             frame.shafts.size() == last_.shafts.size();
    if (!same_things || frame.time >= full_at_)
    {
        full_at_ = frame.time + full_every_;
        last_ = frame;
        return frame;
    }
    out_.run = frame.run, out_.revision = frame.revision, out_.sequence_number = frame.sequence_number;
    out_.step = frame.step, out_.time = frame.time, out_.stamp_ns = frame.stamp_ns;
    keep_moved(frame.bodies, last_.bodies, out_.bodies);
    keep_moved(frame.shafts, last_.shafts, out_.shafts);
    return out_;
}

}  // namespace plab::record
