#include "bus/people_desk.h"

#include <algorithm>
#include <cmath>

#include "bus/request_check.h"

namespace plab::bus
{
namespace
{

bool is_id(const std::string& text) { return text.size() <= PeopleDesk::kLongest && is_utf8(text); }

bool is_rotation(const Quat& q)
{
    const double n = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    return n > 0.25 && n < 4;  // false for NaN
}

bool can_be_right(const wire::UserSample& s)
{
    return is_id(s.user) && is_finite(s.position) && is_rotation(s.orientation) && is_finite(s.linear_velocity) &&
           is_finite(s.angular_velocity) && std::isfinite(s.grip);
}

bool can_be_right(const wire::ViewerSample& s)
{
    return is_id(s.viewer) && is_finite(s.position) && is_finite(s.direction) && is_finite(s.up) && is_finite(s.velocity) &&
           std::isfinite(s.field_of_view) && std::isfinite(s.width) && std::isfinite(s.height);
}

const std::string& component_of(const wire::UserSample& s) { return s.user; }
const std::string& component_of(const wire::ViewerSample& s) { return s.viewer; }

template <class Sample>
void keep_newest(std::vector<publish::ReceivedSample<Sample>>& waiting, PersonMessage<Sample>&& message, std::int64_t arrived_ns)
{
    const auto same = [&](const publish::ReceivedSample<Sample>& r)
    { return r.sample.client == message.sample.client && component_of(r.sample) == component_of(message.sample); };
    const auto found = std::find_if(waiting.begin(), waiting.end(), same);
    if (found == waiting.end())
    {
        if (waiting.size() >= PeopleDesk::kMost) return;
        waiting.push_back({std::move(message.sample), message.gone, message.skipped, arrived_ns});
        return;
    }
    const std::uint64_t skipped = found->skipped + message.skipped + (found->gone || message.gone ? 0 : 1);
    *found = {std::move(message.sample), message.gone, skipped, arrived_ns};
}

}  // namespace

void PeopleDesk::receive(UserMessage&& message, std::int64_t arrived_ns)
{
    if (!(message.gone ? is_id(message.sample.user) : can_be_right(message.sample))) return;
    message.sample.orientation = normalized(message.sample.orientation);
    const std::lock_guard guard(mutex_);
    keep_newest(waiting_.users, std::move(message), arrived_ns);
}

void PeopleDesk::receive(ViewerMessage&& message, std::int64_t arrived_ns)
{
    if (!(message.gone ? is_id(message.sample.viewer) : can_be_right(message.sample))) return;
    const std::lock_guard guard(mutex_);
    keep_newest(waiting_.viewers, std::move(message), arrived_ns);
}

void PeopleDesk::take(publish::ReceivedPeople& people)
{
    people.users.clear(), people.viewers.clear();
    const std::unique_lock guard(mutex_, std::try_to_lock);
    if (!guard.owns_lock()) return;
    std::swap(people, waiting_);
}

}  // namespace plab::bus
