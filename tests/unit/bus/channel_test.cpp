// The channel between plabd and plab-bus: messages arrive as they were sent, and impossible values are detected.
#include <unistd.h>

#include <cstring>
#include <random>

#include "bus/catalogue_mirror.h"
#include "bus/channel/messages.h"
#include "bus/request_desk.h"
#include "doctest/doctest.h"

using namespace plab;
using namespace plab::bus;

namespace
{

PipeMemory memory()
{
    auto made = PipeMemory::make();
    REQUIRE(made.ok());
    return made.take();
}

template <class T>
std::vector<std::byte> bytes_of(const T& value)
{
    Encoder count({});
    count.put(value);
    std::vector<std::byte> out(count.size());
    Encoder encoder(out);
    encoder.put(value);
    CHECK(encoder.fits());
    return out;
}

RequestMessage some_request()
{
    RequestMessage m;
    m.request.client = {1, 2, 3}, m.request.number = 7, m.request.at = 12;
    m.request.operations = {{"set", "ball", "", "", {{"mass", "2 kg"}, {"x", ""}}}};
    return m;
}

}  // namespace

TEST_CASE("records are read back as they were written")
{
    wire::Events events;
    events.run = 3, events.sequence_number = 9;
    events.entries.resize(2);
    events.entries[1].kind = "script.print", events.entries[1].values = {1, 2.5}, events.entries[1].severity = "failure";
    const auto bytes = bytes_of(events);
    wire::Events back;
    Decoder decoder(bytes);
    decoder.get(back);
    REQUIRE(decoder.whole());
    CHECK(back.sequence_number == 9);
    REQUIRE(back.entries.size() == 2);
    CHECK(back.entries[1].kind == "script.print");
    CHECK(back.entries[1].severity == "failure");
    CHECK(back.entries[1].values == std::vector<double>{1, 2.5});

    wire::CollisionInfo collision;
    collision.kind = "rest", collision.depth = 0.5;
    const auto collision_bytes = bytes_of(collision);
    wire::CollisionInfo collision_back;
    Decoder collision_decoder(collision_bytes);
    collision_decoder.get(collision_back);
    CHECK(collision_decoder.whole());
    CHECK(collision_back.kind == "rest");
    CHECK(collision_back.depth == 0.5);
}

TEST_CASE("for any bytes, nothing beyond them is read, and a request takes no more memory than a multiple of its bytes")
{
    std::mt19937_64 random(5);
    const auto good = bytes_of(some_request());
    int whole = 0;
    for (int i = 0; i < 20000; ++i)
    {
        std::vector<std::byte> bytes = good;
        for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<std::byte>(random());
        if (i % 3 == 0) bytes.resize(random() % bytes.size());
        RequestMessage out;
        Decoder decoder(bytes);
        decoder.get(out);
        whole += decoder.whole() ? 1 : 0;
        CHECK(out.request.operations.size() <= bytes.size());
    }
    CHECK(whole > 0);
    CHECK(whole < 20000);
    const std::uint64_t many = ~std::uint64_t{0};
    std::vector<std::byte> lie(sizeof many);
    std::memcpy(lie.data(), &many, sizeof many);
    std::vector<double> numbers;
    Decoder decoder(lie);
    decoder.get(numbers);
    CHECK_FALSE(decoder.fine());
    CHECK(numbers.empty());
}

TEST_CASE("messages of all sizes go through, in order, also those that are larger than the pipe")
{
    for (const bool copies : {false, true})
    {
        const PipeMemory other = memory();
        MessageWriter to(PipeWriter(other.down_state(), other.down()));
        MessageReader from(PipeReader(other.down_state(), other.down()), 1u << 30, copies);
        std::mt19937_64 random(3);
        MessageReader::Message message;
        for (std::uint32_t i = 0; i < 300; ++i)
        {
            const std::size_t size = i % 40 == 7 ? PipeMemory::kDown + 1000 * i : random() % 100000;
            const std::string text(size, static_cast<char>('a' + i % 26));
            REQUIRE(to.send(static_cast<Down>(i), text));
            auto state = from.next(message);
            for (int k = 0; k < 10 && state == MessageReader::State::Nothing; ++k)
            {
                REQUIRE(to.flush());
                state = from.next(message);
            }
            REQUIRE(state == MessageReader::State::Whole);
            CHECK(to.ready());
            CHECK(message.kind == i);
            std::string back;
            Decoder decoder(message.bytes);
            decoder.get(back);
            CHECK(decoder.whole());
            CHECK(back == text);
        }
        CHECK(from.next(message) == MessageReader::State::Nothing);
    }
}

TEST_CASE("impossible counters and lengths are detected, and nothing is read or written")
{
    const PipeMemory shared = memory();
    MessageWriter writer(PipeWriter(shared.down_state(), shared.down()));
    REQUIRE(writer.send(Down::End));
    for (const std::uint64_t lie : {std::uint64_t{17}, ~std::uint64_t{0}, std::uint64_t{1} << 63})
    {
        shared.down_state().read.store(lie);
        CHECK_FALSE(writer.send(Down::End));
    }
    shared.down_state().read.store(16);
    REQUIRE(writer.send(Down::End));
    shared.down_state().read.store(0);  // restored
    CHECK_FALSE(writer.send(Down::End));

    MessageReader reader(PipeReader(shared.up_state(), shared.up()), 1000, true);
    MessageReader::Message message;
    CHECK(reader.next(message) == MessageReader::State::Nothing);
    for (const std::uint64_t lie : {std::uint64_t{PipeMemory::kUp + 1}, ~std::uint64_t{0}})
    {
        shared.up_state().written.store(lie);
        CHECK(reader.next(message) == MessageReader::State::Broken);
    }
    const MessageHead head{0, 0, 1001};
    std::memcpy(shared.up().data(), &head, sizeof head);
    shared.up_state().written.store(sizeof head);
    CHECK(reader.next(message) == MessageReader::State::Broken);
}

TEST_CASE("the shared memory keeps its size in either process")
{
    const PipeMemory shared = memory();
    CHECK(ftruncate(shared.descriptor(), 0) != 0);
    CHECK(ftruncate(shared.descriptor(), 1 << 30) != 0);
}

TEST_CASE("a request is checked again, whatever plab-bus reports about it")
{
    RequestDesk desk;
    std::uint64_t strays = 0;
    CHECK(desk.receive(some_request(), 1).is_new);
    publish::ReceivedRequest request;
    REQUIRE(desk.take(request));
    CHECK(request.operations[0].values[0].text == "2 kg");
    std::uint64_t number = 100;
    const auto why = [&](auto&& change)
    {
        RequestMessage m = some_request();
        m.request.number = ++number;
        change(m);
        CHECK_FALSE(desk.receive(std::move(m), 1).is_new);
        const auto answer = desk.next_answer(strays);
        return answer ? answer->reasons.at(0) : std::string("no answer");
    };
    CHECK(why([](auto& m) { m.request.operations.clear(); }) == "the request has no operation");
    CHECK(why([](auto& m) { m.request.operations.resize(257); }).find("257 operations") != std::string::npos);
    CHECK(why([](auto& m) { m.request.operations[0].values.resize(257); }).find("257 values") != std::string::npos);
    CHECK(why([](auto& m) { m.request.operations[0].target = "b\xe4ll"; }) == "a target is not UTF-8");
    CHECK(why([](auto& m) { m.request.operations[0].blueprint.assign(wire::kMostRequestBytes, 'x'); }).find("bytes of text") !=
          std::string::npos);
    CHECK(why([](auto& m) { m.request.at = -2; }).find("step -2") != std::string::npos);
    CHECK(why([](auto& m) { m.wrong = "\xff"; }) == "the request cannot be decoded");
    CHECK(why([](auto& m) { m.wrong = "too long"; }) == "too long");
    CHECK(why([](auto& m) { m.request.number = 7; }) == "no answer");  // it is already waiting
    CHECK_FALSE(desk.take(request));
    wire::Reply answer;
    answer.client = {1, 2, 3}, answer.number = 7, answer.outcome = "done";
    desk.answer(std::move(answer));
    CHECK(desk.next_answer(strays)->done());
    CHECK_FALSE(desk.receive(some_request(), 2).is_new);  // the reply was lost: the request comes again and is not carried out again
    const auto again = desk.next_answer(strays);
    REQUIRE(again.has_value());
    CHECK(again->repeated);
    CHECK(again->done());
}

TEST_CASE("a desk whose answers are not fetched is full until they are fetched")
{
    RequestDesk desk;
    std::uint64_t strays = 0, number = 1000;
    const auto refuse = [&]
    {
        RequestMessage m = some_request();
        m.request.number = ++number, m.request.operations.clear();
        (void)desk.receive(std::move(m), 1);
    };
    for (int i = 0; i < 1023; ++i) refuse();
    CHECK_FALSE(desk.is_full());
    refuse();
    CHECK(desk.is_full());
    int fetched = 0;
    for (; desk.next_answer(strays); ++fetched) CHECK_FALSE(desk.is_full());
    CHECK(fetched == 1024);
}

TEST_CASE("the catalogue that is kept is the one that was sent")
{
    CatalogueMirror mirror;
    CHECK(mirror.empty());
    publish::CatalogueChange all, more;
    all.everything = true;
    for (const char* id : {"a", "b", "c"}) all.objects.emplace_back().component_id = id;
    all.types.emplace_back().type_name = "T";
    mirror.apply(all);
    more.gone = {"b"}, more.interactions.emplace_back().component_id = "c";
    more.types.emplace_back().type_name = "U";
    mirror.apply(more);
    const publish::CatalogueChange kept = mirror.everything();
    CHECK(kept.everything);
    REQUIRE(kept.objects.size() == 1);
    CHECK(kept.objects[0].component_id == "a");
    REQUIRE(kept.interactions.size() == 1);
    CHECK(kept.types.size() == 2);
    publish::CatalogueChange next;
    next.everything = true;
    mirror.apply(next);
    CHECK(mirror.everything().objects.empty());
    CHECK(mirror.everything().types.size() == 2);
}
