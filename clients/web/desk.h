/// What pages ask of plab-web itself, on a thread of its own: which server a page looks at, recordings, playbacks and branches. It reads
/// each server that some page looks at (feed.h).
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "web/feed.h"
#include "web/job_ask.h"
#include "web/jobs.h"
#include "web/pages.h"
#include "web/recordings.h"

namespace plab::web
{

class Desk
{
public:
    static constexpr std::size_t kMostWaiting = 256;  ///< asks of all pages together

    /// `link`: the server that pages see at first. `recordings`: nothing, if there is no folder for them. `wake`: called after something
    /// was put into `pages`. `stop`: asked several times a second; ends all.
    /// `figures`: of that server, for Prometheus.
    Desk(link::SessionOptions link, std::optional<Recordings> recordings, Pages& pages, NewestFigures& figures, std::function<void()> wake,
         link::Stop stop);
    ~Desk() = default;
    Desk(const Desk&) = delete;
    Desk& operator=(const Desk&) = delete;

private:
    using Clock = std::chrono::steady_clock;
    struct Asked
    {
        PageId page = 0;
        JobAsk ask;
        std::string server;
    };
    /// A server that pages look at, while they do.
    struct Show
    {
        Show(Desk& desk, const std::string& server);
        ~Show() { is_over = true; }

        Audience audience;
        std::atomic<bool> is_over = false;
        Feed feed;  ///< first to go: it uses all of the above
    };

    void run();
    void put(PageId page, const JobAsk& ask, const std::string& server);
    std::deque<Asked> take(std::chrono::milliseconds longest);
    void handle(const Asked& asked);
    void handle_playback(const JobAsk& ask, const Jobs::Answer& answer);
    void look(const Asked& asked);
    void update_shows();
    void send_news();
    void send_state(const Asked* to);
    void push(const Json& message);

    const link::SessionOptions link_;
    std::optional<Recordings> recordings_;
    Pages& pages_;
    NewestFigures& figures_;
    std::function<void()> wake_;
    link::Stop stop_;

    std::mutex mutex_;
    std::condition_variable arrived_;
    std::deque<Asked> waiting_;
    std::atomic<bool> has_servers_ = false;

    // Of the thread alone.
    std::optional<Jobs> jobs_;
    std::map<std::string, Show> shows_;
    std::map<std::string, Clock::time_point> unwatched_;  ///< playbacks: when a page looked at it last
    std::string sent_jobs_, sent_recordings_;             ///< to all pages
    Clock::time_point sent_at_{}, listed_at_{};
    std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace plab::web
