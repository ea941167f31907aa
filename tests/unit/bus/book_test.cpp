// Requests before and after the step loop: form, exactly once, replies that are not sent at once. No DDS here.
#include "bus/process/outbox.h"
#include "bus/process/request_read.h"
#include "bus/request_book.h"
#include "bus/request_check.h"
#include "doctest/doctest.h"
#include "idl/topics.h"

using namespace plab;
using bus::RequestBook;
using Verdict = bus::RequestBook::Verdict;

namespace
{

wire::ClientId client(std::uint16_t n) { return {1, static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(n >> 8)}; }

wire::Reply answer(const wire::ClientId& id, std::uint64_t number, Tick step = 0)
{
    wire::Reply a;
    a.client = id, a.number = number, a.outcome = "done", a.step = step;
    return a;
}

RequestBook::Decision open(RequestBook& book, std::uint16_t client_number, std::uint64_t number, const RequestBook::Load& load = {})
{
    return book.open(client(client_number), number, load, std::nullopt);
}

constexpr RequestBook::Load kFar{.names_step = true}, kShutdown{.shutdown = true};

std::string why(const RequestBook::Decision& decision) { return decision.answer.reasons.at(0); }

/// A request with one operation and one value, whose texts are the caller's.
struct RawRequest
{
    plab_v2_NamedText value{wire::text("name"), wire::text("1")};
    plab_v2_Operation operation{wire::text("set"), wire::text("ball"), wire::text(""), wire::text(""), {1, 1, &value, false}};
    plab_v2_Request wire{{1}, 1, -1, -1, {1, 1, &operation, false}};

    std::string refusal() const
    {
        const auto read = bus::read_request(wire);
        return read ? "" : read.error().text();
    }
};

}  // namespace

TEST_CASE("a request is new once: while it is carried out its answer is awaited, afterwards the answer is repeated")
{
    RequestBook book({});
    CHECK(open(book, 1, 1).verdict == Verdict::New);
    CHECK(open(book, 1, 1).verdict == Verdict::Waiting);
    CHECK(open(book, 2, 1).verdict == Verdict::New);  // the first one of another client
    CHECK(book.waiting() == 2);
    CHECK(book.close(answer(client(1), 1, 77)));
    CHECK(book.waiting() == 1);
    const auto again = open(book, 1, 1);
    CHECK(again.verdict == Verdict::Answered);
    CHECK(again.answer.step == 77);
    CHECK(again.answer.done());
    CHECK_FALSE(book.close(answer(client(1), 1)));  // answered already
    CHECK_FALSE(book.close(answer(client(9), 1)));  // never asked
}

TEST_CASE("numbers may leave gaps but must increase")
{
    RequestBook book({});
    CHECK(open(book, 1, 5).verdict == Verdict::New);
    CHECK(open(book, 1, 9).verdict == Verdict::New);
    const auto late = open(book, 1, 7);
    CHECK(late.verdict == Verdict::Refused);
    CHECK(why(late) == "request 7 came after request 9: numbers must increase");
    CHECK(open(book, 1, 5).verdict == Verdict::Waiting);
    CHECK(open(book, 1, 10).verdict == Verdict::New);
}

TEST_CASE("the last answers are kept, and a request whose answer is forgotten is not carried out again")
{
    RequestBook book({.answers = 3});
    for (std::uint64_t n = 1; n <= 5; ++n)
    {
        CHECK(open(book, 1, n).verdict == Verdict::New);
        CHECK(book.close(answer(client(1), n)));
    }
    CHECK(open(book, 1, 3).verdict == Verdict::Answered);
    CHECK(open(book, 1, 5).verdict == Verdict::Answered);
    const auto forgotten = open(book, 1, 2);
    CHECK(forgotten.verdict == Verdict::Refused);
    CHECK(why(forgotten).find("its reply is no longer kept") != std::string::npos);
}

TEST_CASE("a refusal is an answer like any other: the same request is not accepted later")
{
    RequestBook book({.waiting = 1});
    CHECK(open(book, 1, 1).verdict == Verdict::New);
    const auto full = open(book, 2, 1);
    CHECK(full.verdict == Verdict::Refused);
    CHECK(why(full) ==
          "1 requests, the maximum for all clients together, are already waiting: send it again, with a new number, when "
          "some are done");
    CHECK(book.close(answer(client(1), 1)));
    CHECK(open(book, 2, 1).verdict == Verdict::Answered);
    CHECK(open(book, 2, 2).verdict == Verdict::New);
    CHECK(book.open(client(3), 4, {}, reason("bad")).verdict == Verdict::Refused);
    const auto again = open(book, 3, 4);
    CHECK(again.verdict == Verdict::Answered);
    CHECK(why(again) == "bad");
}

TEST_CASE("one client has a share of the requests that may wait, and regains it when they are answered")
{
    RequestBook book({.waiting_per_client = 2});
    CHECK(open(book, 1, 1, kFar).verdict == Verdict::New);
    CHECK(open(book, 1, 2).verdict == Verdict::New);
    const auto third = open(book, 1, 3);
    CHECK(third.verdict == Verdict::Refused);
    CHECK(why(third).find("2 requests of this client, the maximum for one client, are already waiting: send it again") == 0);
    CHECK(open(book, 2, 1).verdict == Verdict::New);
    CHECK(book.close(answer(client(1), 1)));
    CHECK(open(book, 1, 4).verdict == Verdict::New);
    CHECK(open(book, 1, 5).verdict == Verdict::Refused);
}

TEST_CASE("requests that name a step leave room for those that do not")
{
    RequestBook book({.waiting = 5, .kept_for_next_step = 2});
    for (std::uint16_t client_number = 1; client_number <= 3; ++client_number)
        CHECK(open(book, client_number, 1, kFar).verdict == Verdict::New);
    const auto far = open(book, 4, 1, kFar);
    CHECK(far.verdict == Verdict::Refused);
    CHECK(why(far).find("3 requests that name a step, the maximum of these, are already waiting") == 0);
    CHECK(open(book, 4, 2).verdict == Verdict::New);
    CHECK(open(book, 4, 3).verdict == Verdict::New);
    CHECK(open(book, 4, 4).verdict == Verdict::Refused);
    CHECK(book.close(answer(client(4), 2)));
    CHECK(open(book, 4, 5, kFar).verdict == Verdict::Refused);  // not even when there is room
    CHECK(book.close(answer(client(1), 1)));
    CHECK(open(book, 4, 6, kFar).verdict == Verdict::New);
}

TEST_CASE("a shutdown for the next step finds room when nothing else does")
{
    RequestBook book({.waiting = 2, .waiting_per_client = 2, .kept_for_next_step = 0, .waiting_bytes = 100, .shutdowns = 2});
    CHECK(open(book, 1, 1, {.bytes = 50}).verdict == Verdict::New);
    CHECK(open(book, 1, 2, {.bytes = 50}).verdict == Verdict::New);
    CHECK(open(book, 1, 3).verdict == Verdict::Refused);
    CHECK(open(book, 1, 5, {.shutdown = true, .bytes = 500}).verdict == Verdict::New);        // by the client that used all of it
    CHECK(open(book, 2, 1, {.names_step = true, .shutdown = true}).verdict == Verdict::New);  // refused: it may not name a step
    CHECK(book.waiting() == 4);
    CHECK(why(open(book, 3, 1, kShutdown)) == "2 requests to shut down are already waiting: one is enough");
    CHECK(book.close(answer(client(1), 5)));
    CHECK(open(book, 3, 2, kShutdown).verdict == Verdict::New);
    CHECK(open(book, 3, 3).verdict == Verdict::Refused);  // the room of the others is unchanged
}

TEST_CASE("all requests that wait have a bounded number of bytes, some of them for those that name no step")
{
    RequestBook book({.waiting_bytes = 100, .bytes_kept_for_next_step = 30});
    CHECK(open(book, 1, 1, {.names_step = true, .bytes = 70}).verdict == Verdict::New);
    CHECK(why(open(book, 1, 2, {.names_step = true, .bytes = 1})) ==
          "the request has 1 bytes, and 70 bytes of requests that name a step are already waiting, of at most 70: send it again, with a "
          "new number, when some are done");
    CHECK(open(book, 2, 1, {.bytes = 30}).verdict == Verdict::New);
    CHECK(book.waiting_bytes() == 100);
    CHECK(why(open(book, 3, 1, {.bytes = 7})).find("the request has 7 bytes, and 100 bytes of requests are already waiting") == 0);
    CHECK(book.close(answer(client(1), 1)));
    CHECK(book.waiting_bytes() == 30);
    CHECK(open(book, 3, 2, {.bytes = 70}).verdict == Verdict::New);
}

TEST_CASE("a request counts for the size of its texts plus a fixed amount for each; shutdown may not be combined with others")
{
    publish::ReceivedRequest request;
    request.operations = {{"set", "ball", "", "", {{"mass", "2"}}}};
    CHECK(bus::bytes_of(request) == 3 + 4 + 4 + 1 + 6 * 32);
    CHECK_FALSE(bus::is_shutdown(request));
    request.operations = {{"shutdown", "", "", "", {}}};
    CHECK(bus::is_shutdown(request));
    request.operations[0].blueprint = "x";  // it is refused for that, but takes no room from others
    CHECK_FALSE(bus::is_shutdown(request));
    request.operations[0].blueprint.clear();
    request.operations.push_back(request.operations[0]);
    CHECK_FALSE(bus::is_shutdown(request));
}

TEST_CASE("without id or number a request is refused, and leaves no trace")
{
    RequestBook book({});
    CHECK(book.open({}, 1, {}, std::nullopt).verdict == Verdict::Refused);
    CHECK(book.open(client(1), 0, {}, std::nullopt).verdict == Verdict::Refused);
    CHECK(book.clients() == 0);
    CHECK(book.answer_bytes() == 0);
}

TEST_CASE("the client that was silent for longest is forgotten, but none that still waits")
{
    RequestBook book({.clients = 3});
    CHECK(open(book, 1, 1).verdict == Verdict::New);  // stays open
    for (std::uint16_t client_number = 2; client_number <= 4; ++client_number)
    {
        CHECK(open(book, client_number, 1).verdict == Verdict::New);
        CHECK(book.close(answer(client(client_number), 1)));
    }
    CHECK(book.clients() == 3);
    CHECK(open(book, 1, 1).verdict == Verdict::Waiting);
    CHECK(open(book, 4, 1).verdict == Verdict::Answered);
    CHECK(open(book, 2, 1).verdict == Verdict::New);  // it has been forgotten
}

TEST_CASE("answers take a bounded amount of memory, however long they are")
{
    RequestBook book({.answer_bytes = 100000});
    for (std::uint16_t client_number = 1; client_number <= 50; ++client_number)
        for (std::uint64_t n = 1; n <= 10; ++n)
        {
            CHECK(open(book, client_number, n).verdict == Verdict::New);
            wire::Reply long_one = answer(client(client_number), n);
            long_one.reasons.emplace_back(5000, 'x');
            CHECK(book.close(long_one));
            CHECK(book.answer_bytes() <= 100000);
        }
    CHECK(open(book, 50, 10).verdict == Verdict::Answered);
    CHECK(open(book, 50, 9).verdict == Verdict::Answered);
    CHECK(book.clients() < 10);
}

TEST_CASE("the form of a request is checked")
{
    RawRequest good;
    const auto read = bus::read_request(good.wire);
    REQUIRE(read.ok());
    REQUIRE(read->operations.size() == 1);
    CHECK(read->operations[0].target == "ball");
    CHECK(read->operations[0].values == std::vector<wire::NamedText>{{"name", "1"}});

    RawRequest r;
    r.wire.client[0] = 0;
    CHECK(r.refusal() == "the request has no client id: use 16 random bytes");
    RawRequest zero;
    zero.wire.number = 0;
    CHECK(zero.refusal() == "the request has number 0: the first one of a client is 1");
    RawRequest at;
    at.wire.at = -2;
    CHECK(at.refusal() == "the request is for step -2: steps count from 0, and -1 is the next one");
    RawRequest revision;
    revision.wire.revision = -7;
    CHECK(revision.refusal() == "the request is for revision -7: revisions count from 0, and -1 is any");
    RawRequest none;
    none.wire.operations._length = 0;
    CHECK(none.refusal() == "the request has no operation");
    RawRequest many;
    const std::vector<plab_v2_Operation> operations(wire::kMostOperations + 1, many.operation);
    many.wire.operations = {257, 257, const_cast<plab_v2_Operation*>(operations.data()), false};
    CHECK(many.refusal() == "the request has 257 operations: at most 256 are allowed");
    many.wire.operations._length = 256;
    CHECK(many.refusal().empty());
    RawRequest latin;
    latin.operation.target = wire::text("b\xe4ll");
    CHECK(latin.refusal() == "a target is not UTF-8");
}

TEST_CASE("the text of a request is limited, and so is the number of its values")
{
    RawRequest r;
    const std::string below(wire::kMostRequestBytes - 100, 'x'), above(wire::kMostRequestBytes, 'x');
    r.operation.blueprint = wire::text(below);
    CHECK(r.refusal().empty());
    r.operation.blueprint = wire::text(above);
    CHECK(r.refusal() == "the request has more than 4194304 bytes of text");
    RawRequest empties;
    const std::vector<plab_v2_NamedText> values(wire::kMostValues + 1, {wire::text(""), wire::text("")});
    empties.operation.values = {257, 257, const_cast<plab_v2_NamedText*>(values.data()), false};
    CHECK(empties.refusal() == "operation 1 has 257 values: at most 256 are allowed");
    empties.operation.values._length = 256;
    CHECK(empties.refusal().empty());
    RawRequest second;
    plab_v2_Operation two[] = {second.operation, second.operation};
    two[1].values = {257, 257, const_cast<plab_v2_NamedText*>(values.data()), false};
    second.wire.operations = {2, 2, two, false};
    CHECK(second.refusal() == "operation 2 has 257 values: at most 256 are allowed");
}

TEST_CASE("UTF-8 is as defined by RFC 3629")
{
    for (const char* good : {"", "a", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x98\x80", "\xf4\x8f\xbf\xbf", "\xed\x9f\xbf", "\xee\x80\x80"})
        CHECK(bus::is_utf8(good));
    for (const char* bad : {"\x80", "\xc0\x80", "\xc1\xbf", "\xc3", "\xc3(", "\xe0\x80\x80", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xe2\x82",
                            "\xe2\x82(", "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff", "ok\xfe"})
        CHECK_FALSE(bus::is_utf8(bad));
}

TEST_CASE("a reply that cannot be written is tried again, and after a while given up with a message")
{
    std::vector<std::string> log;
    bus::Trouble trouble([](void* to, const char* line) { static_cast<std::vector<std::string>*>(to)->emplace_back(line); }, &log);
    dds_return_t code = DDS_RETCODE_OUT_OF_RESOURCES;
    std::vector<std::uint64_t> written;
    bus::Outbox outbox(
        [&](const wire::Reply& a)
        {
            if (code == DDS_RETCODE_OK) written.push_back(a.number);
            return code;
        },
        trouble);
    const auto begin = bus::Outbox::Clock::now();
    outbox.send(answer(client(1), 1), begin);
    outbox.send(answer(client(1), 2), begin);
    outbox.retry(begin + std::chrono::seconds(1));
    CHECK_FALSE(outbox.empty());
    code = DDS_RETCODE_OK;
    outbox.retry(begin + std::chrono::seconds(1));
    CHECK(outbox.empty());
    CHECK(written == std::vector<std::uint64_t>{1, 2});
    trouble.report();
    CHECK(log.empty());

    code = DDS_RETCODE_OUT_OF_RESOURCES;
    outbox.send(answer(client(1), 3), begin);
    outbox.retry(begin + std::chrono::seconds(3));
    CHECK(outbox.empty());
    trouble.report();
    REQUIRE(log.size() == 1);
    CHECK(log[0] == "plab/replies: 1 samples could not be written: Out Of Resources");
    CHECK(trouble.lost("plab/replies") == 1);
    trouble.report();
    CHECK(log.size() == 1);
}
