/// What presses on what, for pages that ask for it: read from the bus only while one does.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "idl/json/json.h"
#include "link/session.h"
#include "web/pages.h"

namespace plab::web
{

using wire::Json;

inline constexpr std::size_t kMostContactPoints = 512;  ///< of a message, besides those of what is watched

/// The points with the largest forces, and those of the watched bodies. `pairs` has rows: a, b, whether they sleep. `points` has rows:
/// place in `pairs`; position (m), normal (from a to b) and friction force on b (N), three numbers each; normal force (N), depth (m), 1 if
/// it is an impact.
Json contacts_message(const wire::ContactForces& contacts, const std::set<std::string>& watched);

class ContactFeed
{
public:
    explicit ContactFeed(const link::Session& session) : session_(session) {}

    /// A page has shown what it got, and wants the next.
    void ask(PageId page) { waiting_.insert(page), asked_at_ = Clock::now(); }
    void leave(PageId page) { waiting_.erase(page); }
    /// Gives the newest contacts, if they are due, to all that wait: send(page, message).
    void update(const std::set<std::string>& watched, const std::function<void(PageId, const Json&)>& send);

private:
    using Clock = std::chrono::steady_clock;

    const link::Session& session_;
    std::optional<wire::DataReader<plab_v2_ContactForces>> reader_;
    std::set<PageId> waiting_;
    Clock::time_point asked_at_{}, sent_at_{};
    wire::ContactForces contacts_;  ///< keeps its memory
};

}  // namespace plab::web
