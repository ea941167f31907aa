#include "web/pages.h"

#include <utility>

namespace plab::web
{

std::optional<PageId> Pages::join()
{
    const std::lock_guard lock(mutex_);
    if (pages_.size() >= kMostPages) return {};
    pages_.try_emplace(++last_);
    return last_;
}

void Pages::leave(PageId page)
{
    const std::lock_guard lock(mutex_);
    const auto at = pages_.find(page);
    if (at == pages_.end()) return;
    of_gone_.replaced += at->second.poses_replaced(), of_gone_.times_behind += at->second.times_behind();
    pages_.erase(at);
    arrived_.push_back({page, {}, true});
}

bool Pages::receive(PageId page, std::string text)
{
    const std::lock_guard lock(mutex_);
    if (arrived_.size() >= kMostWaiting) return false;
    arrived_.push_back({page, std::move(text), false});
    return true;
}

void Pages::acknowledge(PageId page)
{
    const std::lock_guard lock(mutex_);
    if (const auto at = pages_.find(page); at != pages_.end()) at->second.acknowledge();
}

MessagePtr Pages::take(PageId page)
{
    const std::lock_guard lock(mutex_);
    const auto at = pages_.find(page);
    return at == pages_.end() ? nullptr : at->second.take();
}

bool Pages::has_any(PageId page) const
{
    const std::lock_guard lock(mutex_);
    const auto at = pages_.find(page);
    return at != pages_.end() && at->second.has_any();
}

std::vector<Arrived> Pages::arrived()
{
    const std::lock_guard lock(mutex_);
    return std::exchange(arrived_, {});
}

std::size_t Pages::count() const
{
    const std::lock_guard lock(mutex_);
    return pages_.size();
}

PageFigures Pages::figures() const
{
    const std::lock_guard lock(mutex_);
    PageFigures out = of_gone_;
    out.pages = pages_.size();
    for (const auto& [id, outbox] : pages_) out.replaced += outbox.poses_replaced(), out.times_behind += outbox.times_behind();
    return out;
}

void Pages::push(const MessagePtr& message)
{
    const std::lock_guard lock(mutex_);
    for (auto& [id, outbox] : pages_) outbox.push(message);
}

void Pages::push_to(PageId page, const MessagePtr& message)
{
    const std::lock_guard lock(mutex_);
    if (const auto at = pages_.find(page); at != pages_.end()) at->second.push(message);
}

void Pages::put(const Poses& poses)
{
    const std::lock_guard lock(mutex_);
    newest_ = poses;
    for (auto& [id, outbox] : pages_) outbox.put(poses);
}

void Pages::forget_poses()
{
    const std::lock_guard lock(mutex_);
    newest_ = {};
}

std::vector<PageId> Pages::begin(const std::function<MessagePtr()>& whole)
{
    const std::lock_guard lock(mutex_);
    MessagePtr message;
    std::vector<PageId> out;
    for (auto& [id, outbox] : pages_)
    {
        if (!outbox.wants_all()) continue;
        if (message == nullptr) message = whole();
        outbox.begin(message);
        if (newest_.key != nullptr) outbox.put(newest_);
        out.push_back(id);
    }
    return out;
}

}  // namespace plab::web
