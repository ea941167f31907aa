#include "bus/channel/messages.h"

#include <algorithm>

namespace plab::bus
{

bool MessageWriter::flush()
{
    if (rest_.empty()) return true;
    // Announce the need for room before checking: room that appears after the check then sets the wake event.
    pipe_.ask_for_room();
    const auto room = pipe_.room();
    if (!room) return false;
    const std::size_t bytes = std::min(room->size(), rest_.size());
    if (bytes > 0) std::memcpy(room->data(), rest_.data(), bytes), pipe_.commit(bytes), committed_ = true;
    rest_ = rest_.subspan(bytes);
    constexpr std::size_t kKept = 1u << 20;
    if (rest_.empty() && buffer_.capacity() > kKept) buffer_ = {};
    return true;
}

MessageReader::State MessageReader::next(Message& message)
{
    if (held_ > 0) release(std::exchange(held_, 0));
    auto waiting = pipe_.waiting();
    if (!waiting) return State::Broken;
    if (!head_)
    {
        if (waiting->size() < sizeof(MessageHead)) return State::Nothing;
        MessageHead head;
        std::memcpy(&head, waiting->data(), sizeof head);
        if (head.bytes > most_) return State::Broken;
        if (!copies_ && head.bytes <= waiting->size() - sizeof head)
        {
            held_ = sizeof head + static_cast<std::size_t>(head.bytes);
            message = {head.kind, waiting->subspan(sizeof head, static_cast<std::size_t>(head.bytes))};
            return State::Whole;
        }
        // The rest of a message that fits may still be on its way; a message larger than the limit is an error.
        if (!copies_ && head.bytes <= PipeMemory::kDown / 2) return State::Nothing;
        head_ = head;
        buffer_.clear();
        release(sizeof head);
        waiting = waiting->subspan(sizeof head);
    }
    const std::size_t missing = static_cast<std::size_t>(head_->bytes) - buffer_.size();
    const std::size_t bytes = std::min(missing, waiting->size());
    buffer_.insert(buffer_.end(), waiting->data(), waiting->data() + bytes);
    if (bytes > 0) release(bytes);
    if (bytes < missing) return State::Nothing;
    message = {head_->kind, buffer_};
    head_.reset();
    return State::Whole;
}

}  // namespace plab::bus
