#include "web/outbox.h"

#include <utility>

namespace plab::web
{

void Outbox::add(MessagePtr message)
{
    bytes_ += message->size();
    messages_.push_back(std::move(message));
}

void Outbox::begin(MessagePtr whole)
{
    messages_.clear(), bytes_ = 0;
    add(std::move(whole));
    is_current_ = true;
    key_sent_ = 0;
}

void Outbox::begin_anew(MessagePtr first)
{
    begin(std::move(first));
    poses_ = {};
    unacknowledged_ = 0;
    is_current_ = false;
}

void Outbox::push(MessagePtr message)
{
    if (!is_current_) return;
    if (messages_.empty() || (messages_.size() < kMostMessages && bytes_ + message->size() <= kMostBytes)) return add(std::move(message));
    messages_.clear(), bytes_ = 0;
    poses_ = {};
    is_current_ = false;
    ++times_behind_;
}

void Outbox::put(const Poses& poses)
{
    if (!is_current_) return;
    if (poses_.key != nullptr) ++poses_replaced_;
    poses_ = poses;
}

void Outbox::acknowledge()
{
    if (unacknowledged_ > 0) --unacknowledged_;
}

MessagePtr Outbox::take()
{
    if (!messages_.empty())
    {
        MessagePtr out = std::move(messages_.front());
        messages_.pop_front();
        bytes_ -= out->size();
        return out;
    }
    if (!can_send_poses()) return nullptr;
    ++unacknowledged_;
    if (key_sent_ != poses_.key_number)
    {
        key_sent_ = poses_.key_number;
        return poses_.delta == nullptr ? std::exchange(poses_, {}).key : poses_.key;
    }
    Poses poses = std::exchange(poses_, {});
    return poses.delta != nullptr ? poses.delta : poses.key;
}

}  // namespace plab::web
