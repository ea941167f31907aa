/// The pages that are open: their outboxes, and what they sent. Between the thread of the sockets and the thread that talks to the server;
/// neither waits for the other longer than a copy of pointers takes.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "web/metrics_text.h"
#include "web/outbox.h"
#include "websocket/server.h"

namespace plab::web
{

using PageId = websocket::ConnectionId;

struct Arrived
{
    PageId page = 0;
    std::string text;
    bool has_left = false;
};

class Pages
{
public:
    static constexpr std::size_t kMostPages = 64;
    static constexpr std::size_t kMostWaiting = 1024;  ///< texts of all pages together

    // For the thread of the sockets.
    std::optional<PageId> join();  ///< nothing: there are kMostPages
    void leave(PageId page);
    /// False: too many texts wait; this one is not taken.
    bool receive(PageId page, std::string text);
    void acknowledge(PageId page);
    MessagePtr take(PageId page);
    bool has_any(PageId page) const;

    // For the thread that talks to the server.
    std::vector<Arrived> arrived();
    std::size_t count() const;
    PageFigures figures() const;
    void push(const MessagePtr& message);  ///< to all that are current
    void push_to(PageId page, const MessagePtr& message);
    void put(const Poses& poses);
    /// Poses of before are of another server.
    void forget_poses();
    /// Sends the whole scene, and the newest poses, to each page that wants it; returns these pages.
    std::vector<PageId> begin(const std::function<MessagePtr()>& whole);

private:
    mutable std::mutex mutex_;
    std::map<PageId, Outbox> pages_;
    std::vector<Arrived> arrived_;
    Poses newest_;  ///< for late joiners
    PageId last_ = 0;
    PageFigures of_gone_;  ///< what pages that are closed have counted
};

}  // namespace plab::web
