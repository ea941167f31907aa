/// Hands of pages: a mouse that grabs a body. A hand is a State/User with a Constraint/Grab, which are added to the scene when a page grabs
/// and removed when it lets go, or is closed.
#pragma once

#include <map>
#include <memory>

#include "link/person.h"
#include "link/requests.h"
#include "web/pages.h"
#include "web/translate.h"

namespace plab::web
{

class Hands
{
public:
    static constexpr std::size_t kMost = 8;

    Hands(const link::Session& session, link::Requests& requests) : session_(session), requests_(requests) {}

    /// The page's reply is that of the request that adds the hand.
    void grab(PageId page, const Grab& grab, link::Requests::Then then);
    void move(PageId page, const Vec3& position);
    void release(PageId page);

private:
    struct Hand
    {
        std::string id;
        Vec3 position;
        std::unique_ptr<link::UserWriter> writer;  ///< once the scene has the hand
        bool is_added = false, is_released = false;
    };
    void added(PageId page, const std::string& id, const Result<link::Reply>& reply);
    void remove(const Hand& hand);

    const link::Session& session_;
    link::Requests& requests_;
    std::map<PageId, Hand> hands_;
    std::uint64_t last_ = 0;
};

}  // namespace plab::web
