#include "web/hands.h"

#include <chrono>

#include "link/text.h"
#include "plab/xml_text.h"

namespace plab::web
{
namespace
{

std::string text_of(const Vec3& v) { return link::number_text(v.x) + " " + link::number_text(v.y) + " " + link::number_text(v.z); }

}  // namespace

void Hands::grab(PageId page, const Grab& grab, link::Requests::Then then)
{
    if (hands_.contains(page)) return then(reason("this page holds something already: let go first"));
    if (hands_.size() >= kMost) return then(reason("other pages hold " + std::to_string(kMost) + " bodies; more hands are not given"));
    Hand hand;
    const auto stamp = std::chrono::system_clock::now().time_since_epoch().count() % 1'000'000'000;
    hand.id = "web_grab_" + std::to_string(stamp) + "_" + std::to_string(++last_);
    hand.position = grab.position;
    const std::string body = xml_text(grab.body);
    const std::string xml = "<plab version='1'><component id='" + hand.id + "_hand' type='State/User' position='" + text_of(grab.position) +
                            "'/><component id='" + hand.id + "' type='Constraint/Grab' user='" + hand.id + "_hand' body='" + body +
                            "' hold='" + body + "' max_force='" + link::number_text(grab.force) + "'/></plab>";
    const std::string id = hand.id;
    hands_.emplace(page, std::move(hand));
    requests_.send({{{"add", "", "grab", xml}}, {}, {}},
                   [this, page, id, then = std::move(then)](const Result<link::Reply>& reply)
                   {
                       added(page, id, reply);
                       then(reply);
                   });
}

void Hands::added(PageId page, const std::string& id, const Result<link::Reply>& reply)
{
    const auto at = hands_.find(page);
    if (at == hands_.end() || at->second.id != id) return;
    Hand& hand = at->second;
    if (!reply || !reply->done())
    {
        hands_.erase(at);
        return;
    }
    hand.is_added = true;
    if (hand.is_released)
    {
        remove(hand);
        hands_.erase(at);
        return;
    }
    // The server reads plab/users from its start on, so this waits for a few milliseconds.
    if (auto writer = link::UserWriter::open(session_, id + "_hand", link::Seconds(1)); writer)
        hand.writer = std::make_unique<link::UserWriter>(writer.take());
    move(page, hand.position);
}

void Hands::move(PageId page, const Vec3& position)
{
    const auto at = hands_.find(page);
    if (at == hands_.end()) return;
    at->second.position = position;
    if (at->second.writer == nullptr) return;
    wire::UserSample sample;
    sample.position = position;
    (void)at->second.writer->send(std::move(sample));
}

void Hands::release(PageId page)
{
    const auto at = hands_.find(page);
    if (at == hands_.end()) return;
    at->second.is_released = true;
    at->second.writer = nullptr;       // before the component: samples for one that is gone would be refused
    if (!at->second.is_added) return;  // removed when the scene has it
    remove(at->second);
    hands_.erase(at);
}

void Hands::remove(const Hand& hand)
{
    requests_.send({{{"remove", hand.id}, {"remove", hand.id + "_hand"}}, {}, {}}, [](const Result<link::Reply>&) {});
}

}  // namespace plab::web
