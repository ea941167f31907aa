#include "web/pages.h"

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
    groups_[at->second.server].arrived.push_back({page, {}, true});
    const Outbox& outbox = at->second.outbox;
    of_gone_.replaced += outbox.poses_replaced(), of_gone_.times_behind += outbox.times_behind();
    pages_.erase(at);
}

bool Pages::receive(PageId page, std::string text)
{
    const std::lock_guard lock(mutex_);
    const auto at = pages_.find(page);
    if (at == pages_.end() || waiting_ >= kMostWaiting) return false;
    groups_[at->second.server].arrived.push_back({page, std::move(text), false});
    ++waiting_;
    return true;
}

void Pages::acknowledge(PageId page)
{
    const std::lock_guard lock(mutex_);
    if (const auto at = pages_.find(page); at != pages_.end()) at->second.outbox.acknowledge();
}

MessagePtr Pages::take(PageId page)
{
    const std::lock_guard lock(mutex_);
    const auto at = pages_.find(page);
    return at == pages_.end() ? nullptr : at->second.outbox.take();
}

bool Pages::has_any(PageId page) const
{
    const std::lock_guard lock(mutex_);
    const auto at = pages_.find(page);
    return at != pages_.end() && at->second.outbox.has_any();
}

void Pages::push_to_all(const MessagePtr& message)
{
    const std::lock_guard lock(mutex_);
    for (auto& [id, page] : pages_) page.outbox.push(message);
}

void Pages::push_to(PageId page, const MessagePtr& message)
{
    const std::lock_guard lock(mutex_);
    if (const auto at = pages_.find(page); at != pages_.end()) at->second.outbox.push(message);
}

void Pages::look(PageId page, const std::string& server, const MessagePtr& first)
{
    const std::lock_guard lock(mutex_);
    const auto at = pages_.find(page);
    if (at == pages_.end()) return;
    groups_[at->second.server].arrived.push_back({page, {}, true});
    at->second.server = server;
    at->second.outbox.begin_anew(first);
}

std::map<std::string, std::size_t> Pages::looked_at() const
{
    const std::lock_guard lock(mutex_);
    std::map<std::string, std::size_t> out;
    for (const auto& [id, page] : pages_) ++out[page.server];
    return out;
}

PageFigures Pages::figures() const
{
    const std::lock_guard lock(mutex_);
    PageFigures out = of_gone_;
    out.pages = pages_.size();
    for (const auto& [id, page] : pages_) out.replaced += page.outbox.poses_replaced(), out.times_behind += page.outbox.times_behind();
    return out;
}

Audience::~Audience()
{
    const std::lock_guard lock(pages_.mutex_);
    const auto group = pages_.groups_.find(server_);
    if (group == pages_.groups_.end()) return;
    for (const Arrived& one : group->second.arrived) pages_.waiting_ -= one.has_left ? 0 : 1;
    pages_.groups_.erase(group);
}

std::vector<Arrived> Audience::arrived()
{
    const std::lock_guard lock(pages_.mutex_);
    auto out = std::exchange(pages_.groups_[server_].arrived, {});
    for (const Arrived& one : out) pages_.waiting_ -= one.has_left ? 0 : 1;
    return out;
}

std::size_t Audience::count() const
{
    const std::lock_guard lock(pages_.mutex_);
    std::size_t out = 0;
    for (const auto& [id, page] : pages_.pages_) out += page.server == server_ ? 1 : 0;
    return out;
}

void Audience::push(const MessagePtr& message)
{
    const std::lock_guard lock(pages_.mutex_);
    for (auto& [id, page] : pages_.pages_)
        if (page.server == server_) page.outbox.push(message);
}

void Audience::put(const Poses& poses)
{
    const std::lock_guard lock(pages_.mutex_);
    pages_.groups_[server_].newest = poses;
    for (auto& [id, page] : pages_.pages_)
        if (page.server == server_) page.outbox.put(poses);
}

void Audience::forget_poses()
{
    const std::lock_guard lock(pages_.mutex_);
    pages_.groups_[server_].newest = {};
}

std::vector<PageId> Audience::begin(const std::function<MessagePtr()>& whole)
{
    const std::lock_guard lock(pages_.mutex_);
    const Poses& newest = pages_.groups_[server_].newest;
    MessagePtr message;
    std::vector<PageId> out;
    for (auto& [id, page] : pages_.pages_)
    {
        if (page.server != server_ || !page.outbox.wants_all()) continue;
        if (message == nullptr) message = whole();
        page.outbox.begin(message);
        if (newest.key != nullptr) page.outbox.put(newest);
        out.push_back(id);
    }
    return out;
}

}  // namespace plab::web
