#include "web/outbox.h"

#include <doctest/doctest.h>

#include <string>

#include "web/pages.h"

using namespace plab::web;

namespace
{

MessagePtr text(const std::string& content) { return std::make_shared<Message>(content); }
std::string content_of(const MessagePtr& message)
{
    return message == nullptr ? "" : std::string(reinterpret_cast<const char*>(message->content()), message->size());
}
Poses poses(std::uint64_t key, const std::string& content, bool is_delta)
{
    return {key, text("key" + std::to_string(key)), is_delta ? text(content) : nullptr};
}

}  // namespace

TEST_CASE("a page gets the whole scene first, and nothing before it")
{
    Outbox box;
    CHECK(box.wants_all());
    box.push(text("lost"));
    box.put(poses(1, "", false));
    CHECK(box.take() == nullptr);
    box.begin(text("all"));
    CHECK_FALSE(box.wants_all());
    box.push(text("more"));
    CHECK(content_of(box.take()) == "all");
    CHECK(content_of(box.take()) == "more");
    CHECK(box.take() == nullptr);
}

TEST_CASE("of poses the newest wins, and a delta comes behind its key frame")
{
    Outbox box;
    box.begin(text("all"));
    (void)box.take();
    box.put(poses(1, "d1", true));
    box.put(poses(1, "d2", true));
    CHECK(box.poses_replaced() == 1);
    CHECK(content_of(box.take()) == "key1");
    CHECK(content_of(box.take()) == "d2");
    CHECK(box.take() == nullptr);
    box.put(poses(1, "d3", true));
    CHECK(content_of(box.take()) == "d3");
}

TEST_CASE("a page that draws nothing gets no more than three messages of poses, however many come")
{
    Outbox box;
    box.begin(text("all"));
    (void)box.take();
    std::size_t sent = 0;
    for (std::uint64_t i = 1; i <= 1000; ++i)
    {
        box.put(poses(i, "", false));
        while (box.take() != nullptr) ++sent;
    }
    CHECK(sent == Outbox::kMostPoses);
    CHECK(box.poses_replaced() == 1000 - Outbox::kMostPoses - 1);
    box.acknowledge();
    CHECK(content_of(box.take()) == "key1000");
    CHECK(box.take() == nullptr);
    // More acknowledgements than messages give no credit.
    for (int i = 0; i < 100; ++i) box.acknowledge();
    sent = 0;
    for (std::uint64_t i = 2001; i <= 2100; ++i)
    {
        box.put(poses(i, "", false));
        while (box.take() != nullptr) ++sent;
    }
    CHECK(sent == Outbox::kMostPoses);
}

TEST_CASE("a page that takes nothing keeps a bounded queue, loses it as a whole, and begins again")
{
    Outbox box;
    box.begin(text("all"));
    for (std::size_t i = 0; i < 2 * Outbox::kMostMessages; ++i) box.push(text("x"));
    CHECK(box.times_behind() == 1);
    CHECK(box.wants_all());
    CHECK(box.take() == nullptr);
    box.begin(text("all again"));
    CHECK(content_of(box.take()) == "all again");

    const std::string large(Outbox::kMostBytes / 2 + 1, 'x');
    box.push(text(large));
    box.push(text(large));
    CHECK(box.times_behind() == 2);
    CHECK_FALSE(box.has_any());
}

TEST_CASE("a scene that is larger than the bound is sent all the same, if nothing else waits")
{
    Outbox box;
    box.begin(text(std::string(2 * Outbox::kMostBytes, 'x')));
    CHECK(box.take()->size() == 2 * Outbox::kMostBytes);
    box.push(text(std::string(2 * Outbox::kMostBytes, 'y')));
    CHECK(box.take()->size() == 2 * Outbox::kMostBytes);
}

TEST_CASE("pages are bounded, and so is what they say")
{
    Pages pages;
    Audience audience(pages);
    for (std::size_t i = 0; i < Pages::kMostPages; ++i) REQUIRE(pages.join());
    CHECK_FALSE(pages.join());
    for (std::size_t i = 0; i < Pages::kMostWaiting; ++i) REQUIRE(pages.receive(1, "x"));
    CHECK_FALSE(pages.receive(1, "x"));
    CHECK(audience.arrived().size() == Pages::kMostWaiting);
    CHECK(pages.receive(1, "x"));
    pages.leave(7);
    CHECK(pages.join());
    const auto arrived = audience.arrived();
    REQUIRE(arrived.size() == 2);
    CHECK(arrived[1].has_left);
    CHECK(arrived[1].page == 7);
}

TEST_CASE("a late joiner gets the scene and the newest poses, although none come")
{
    Pages pages;
    Audience audience(pages);
    audience.put(poses(5, "d", true));
    const auto page = pages.join();
    REQUIRE(page);
    CHECK(audience.begin([] { return text("all"); }).size() == 1);
    CHECK(content_of(pages.take(*page)) == "all");
    CHECK(content_of(pages.take(*page)) == "key5");
    CHECK(content_of(pages.take(*page)) == "d");
    CHECK(audience.begin([] { return text("all"); }).empty());
}

TEST_CASE("a page sees the server that it looks at, and nothing of the one before")
{
    Pages pages;
    Audience home(pages), other(pages, "other");
    const auto page = pages.join(), second = pages.join();
    REQUIRE((page && second));
    (void)home.begin([] { return text("home"); });
    home.put(poses(5, "d", true));
    home.push(text("old"));
    other.put(poses(7, "e", true));
    pages.look(*page, "other", text("looking"));
    home.push(text("for those at home"));
    CHECK(content_of(pages.take(*page)) == "looking");
    CHECK(pages.take(*page) == nullptr);
    CHECK(other.begin([] { return text("other"); }).size() == 1);
    CHECK(content_of(pages.take(*page)) == "other");
    CHECK(content_of(pages.take(*page)) == "key7");
    CHECK(content_of(pages.take(*second)) == "home");
    CHECK(content_of(pages.take(*second)) == "old");
    CHECK(home.count() == 1);
    CHECK(pages.looked_at() == std::map<std::string, std::size_t>{{"", 1}, {"other", 1}});
    // Whoever talks to the server before learns that the page has left, and gets nothing of it any more.
    const auto left = home.arrived();
    REQUIRE(left.size() == 1);
    CHECK((left[0].has_left && left[0].page == *page));
    REQUIRE(pages.receive(*page, "hello"));
    CHECK(home.arrived().empty());
    REQUIRE(other.arrived().size() == 1);
}

TEST_CASE("what pages say to a server that nobody reads any more makes room for others")
{
    Pages pages;
    const auto page = pages.join();
    REQUIRE(page);
    {
        Audience gone(pages, "gone");
        pages.look(*page, "gone", text("looking"));
        for (std::size_t i = 0; i < Pages::kMostWaiting; ++i) REQUIRE(pages.receive(*page, "x"));
        CHECK_FALSE(pages.receive(*page, "x"));
    }
    CHECK(pages.receive(*page, "x"));
}
