/// The pages that are open: their outboxes, and what they sent. Between the thread of the sockets and the thread that talks to the server;
/// neither waits for the other longer than a copy of pointers takes.
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
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

/// Each page looks at one server: at first at the one of this program, which is called "" here.
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

    // For any thread.
    void push_to_all(const MessagePtr& message);  ///< to all that are current
    void push_to(PageId page, const MessagePtr& message);
    /// From now on the page looks at that server; `first` is the first message that it gets then.
    void look(PageId page, const std::string& server, const MessagePtr& first);
    /// How many pages look at which server.
    std::map<std::string, std::size_t> looked_at() const;
    PageFigures figures() const;

private:
    friend class Audience;
    struct Page
    {
        Outbox outbox;
        std::string server;
    };
    /// Of one server.
    struct Group
    {
        std::vector<Arrived> arrived;
        Poses newest;  ///< for late joiners
    };

    mutable std::mutex mutex_;
    std::map<PageId, Page> pages_;
    std::map<std::string, Group> groups_;
    std::size_t waiting_ = 0;  ///< texts of all groups
    PageId last_ = 0;
    PageFigures of_gone_;  ///< what pages that are closed have counted
};

/// The pages that look at one server, for the thread that talks to it.
class Audience
{
public:
    /// The pages must outlive it.
    explicit Audience(Pages& pages, std::string server = {}) : pages_(pages), server_(std::move(server)) {}
    /// What its pages say from now on is for whoever comes next.
    ~Audience();
    Audience(const Audience&) = delete;
    Audience& operator=(const Audience&) = delete;

    std::vector<Arrived> arrived();
    std::size_t count() const;
    void push(const MessagePtr& message);  ///< to all that are current
    void push_to(PageId page, const MessagePtr& message) { pages_.push_to(page, message); }
    void put(const Poses& poses);
    /// Poses of before are of another server.
    void forget_poses();
    /// Sends the whole scene, and the newest poses, to each page that wants it; returns these pages.
    std::vector<PageId> begin(const std::function<MessagePtr()>& whole);

private:
    Pages& pages_;
    std::string server_;
};

}  // namespace plab::web
