// plabctl record when it is killed, and when its disk fails: real programs, each in its own process.
#include "server.h"

#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "idl/recording/cdr.h"
#include "idl/recording/reader.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr Milliseconds kLong(10000);
const std::string kScene = scene_file("fan_and_balloons.xml");

std::string fresh(const std::string& name)
{
    const std::string file = scratch_file(name);
    std::filesystem::remove(file);
    return file;
}

std::uintmax_t size_of(const std::string& file)
{
    std::error_code none;
    const std::uintmax_t size = std::filesystem::file_size(file, none);
    return none ? 0 : size;
}

/// False after some seconds.
template <class Condition>
bool comes_true(Condition is_so)
{
    for (int i = 0; i < 2500 && !is_so(); ++i) std::this_thread::sleep_for(Milliseconds(2));
    return is_so();
}

Process record(const Server& server, const std::string& file)
{
    return Process({program("plabctl"), "--server", server.name(), "--json", "record", "-o", file});
}

struct Content
{
    std::uint64_t messages = 0;
    std::int64_t newest_ns = 0;  ///< s since 1970 in ns: when the server had made the latest frame
    bool is_closed = false;
};

/// All of a file. Checks that nothing of it is damaged, out of order, missing in between, or there twice.
Content read_whole(const std::string& file, bool may_have_gaps = false)
{
    Content out;
    auto reader = recording::McapReader::open(file);
    REQUIRE_MESSAGE(reader.ok(), reader.error().text());
    CHECK(reader->index().troubles.empty());
    out.is_closed = reader->index().is_closed;
    std::map<std::string, std::uint32_t> numbers;
    std::uint64_t log_time = 0;
    std::int64_t step = -1;
    std::uint64_t sample = 0;
    recording::Decoder decoder;
    recording::Sample<plab_v2_Frame> frame;
    recording::Cursor messages = reader->messages();
    for (auto next = messages.next();; next = messages.next(), ++out.messages)
    {
        REQUIRE_MESSAGE(next.ok(), next.error().text());
        if (!*next) return out;
        const auto& [channel, message] = **next;
        REQUIRE(message.log_time >= log_time);
        log_time = message.log_time;
        std::uint32_t& number = numbers[channel->topic];
        REQUIRE((may_have_gaps ? message.sequence >= number : message.sequence == number));
        number = message.sequence + 1;
        if (channel->topic != std::string(wire::topic_of<plab_v2_Frame>().name)) continue;
        REQUIRE(decoder.decode(message.data, frame));
        REQUIRE(frame->sequence_number > sample);
        REQUIRE(frame->step >= step);  // a new reader gets the frame of the present step again
        sample = frame->sequence_number, step = frame->step, out.newest_ns = frame->stamp_ns;
    }
}

std::int64_t wall_ns()
{
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Another reader of the same frames: which of them were available at which time.
class Witness
{
public:
    void take(wire::DataReader<plab_v2_Frame>& frames)
    {
        frames.take(
            [&](const plab_v2_Frame& frame, const dds_sample_info_t& info)
            {
                if (info.valid_data) seen_.emplace_back(wall_ns(), frame.stamp_ns);
            });
    }
    /// The time at which the latest frame received by then was made; 0: none was.
    std::int64_t before(std::int64_t then) const
    {
        std::int64_t out = 0;
        for (const auto& [arrived, made] : seen_)
            if (arrived <= then) out = std::max(out, made);
        return out;
    }

private:
    std::vector<std::pair<std::int64_t, std::int64_t>> seen_;  ///< ns since 1970: arrived, made
};

/// A file of that process cannot grow beyond `bytes`: as on a full disk, a write is short, and the next one fails.
void limit_files(const Process& process, rlim_t bytes)
{
    rlimit limit{};
    REQUIRE(::prlimit(process.pid(), RLIMIT_FSIZE, nullptr, &limit) == 0);
    limit.rlim_cur = std::min(bytes, limit.rlim_max);
    REQUIRE(::prlimit(process.pid(), RLIMIT_FSIZE, &limit, nullptr) == 0);
}

}  // namespace

TEST_CASE(
    "a recorder that is killed at any moment loses the last 20 ms at most, unless it is held up, and leaves a file that is whole up to "
    "there")
{
    constexpr int kKills = 10;
    // A chunk is 12 ms old at the most; before that a frame goes through two threads of the recorder. That takes a millisecond,
    // but other programs on the machine may delay them: by 20 ms at the most, and not in half of the kills. The delay of the bus
    // itself is measured by the test's own reader.
    constexpr std::int64_t kPromisedNs = 20'000'000, kHeldUpNs = 20'000'000;
    int within = 0;
    const Server server(kScene, {"--rate", "real", "--states", "all"});
    std::mt19937 random(11);
    std::vector<double> ages;
    const link::Session session = server.session();
    auto frames = session.reader<plab_v2_Frame>();
    REQUIRE(frames.ok());
    for (int i = 0; i < kKills; ++i)
    {
        CAPTURE(i);
        const std::string file = fresh("killed.mcap"), saved = fresh("saved.mcap");
        Process recorder = record(server, file);
        REQUIRE_MESSAGE(comes_true([&] { return size_of(file) > 40'000 && read_whole(file).newest_ns > 0; }), recorder.errors());
        Witness witness;
        const auto end = wall_ns() + 60'000'000 + static_cast<std::int64_t>(random() % 200'000'000);
        while (wall_ns() < end)
        {
            (void)session.wait(*frames, Seconds(0.002));
            witness.take(*frames);
        }
        const std::int64_t killed_ns = wall_ns();
        recorder.signal(SIGKILL);
        REQUIRE(recorder.wait(kLong) == 128 + SIGKILL);

        const Content left = read_whole(file);
        CHECK(!left.is_closed);
        REQUIRE(witness.before(killed_ns - kPromisedNs - kHeldUpNs) > 0);
        CHECK(left.newest_ns >= witness.before(killed_ns - kPromisedNs - kHeldUpNs));
        within += left.newest_ns >= witness.before(killed_ns - kPromisedNs);
        ages.push_back(static_cast<double>(killed_ns - left.newest_ns) * 1e-6);
        const Outcome recovered = run({program("plabctl"), "--json", "recover", file, "-o", saved});
        CHECK_MESSAGE((recovered.code == 0 || recovered.code == 5), recovered.errors);
        const Content whole = read_whole(saved);
        CHECK(whole.is_closed);
        CHECK(whole.messages == left.messages);
        CHECK(whole.newest_ns == left.newest_ns);
        const auto report = nlohmann::json::parse(recovered.output);
        // A write in progress is truncated at the end of the file; everything else is usable.
        CHECK(report["lost"].size() <= 1);
    }
    std::sort(ages.begin(), ages.end());
    MESSAGE("age of the last frame in the file: median ", ages[kKills / 2], " ms, oldest ", ages.back(), " ms");
    CHECK(within > kKills / 2);
    CHECK(ages.front() > 0);
}

TEST_CASE("leaving out topics that a replay needs gives a warning")
{
    const Server server(kScene, {"--rate", "real"});
    const Outcome few = control(server, {"record", "-o", fresh("few.mcap"), "-d", "0.1", "--topics", "plab/states", "plab/hashes"});
    CHECK_MESSAGE(few.code == 0, few.errors);
    CHECK_MESSAGE(has(few.errors, "the recording cannot be replayed: --topics is without plab/snapshots, plab/journal\n"), few.errors);
    const Outcome all = control(server, {"record", "-o", fresh("all.mcap"), "-d", "0.1"});
    CHECK_MESSAGE(all.code == 0, all.errors);
    CHECK_MESSAGE(!has(all.errors, "replayed"), all.errors);
}

TEST_CASE("a full disk: the recorder reports it, ends when requested, and everything before can be read")
{
    const Server server(kScene, {"--rate", "real", "--states", "all"});
    const std::string file = fresh("full.mcap"), saved = fresh("full_saved.mcap");
    Process recorder = record(server, file);
    REQUIRE_MESSAGE(comes_true([&] { return size_of(file) > 20'000; }), recorder.errors());
    const std::uint64_t before = read_whole(file).messages;
    const auto limit = size_of(file) + 700;
    limit_files(recorder, limit);
    CHECK_MESSAGE(recorder.wait_for("cannot write: File too large; retrying", kLong), recorder.errors());
    std::this_thread::sleep_for(Milliseconds(1300));  // it is tried again, in vain
    CHECK(recorder.running());
    recorder.signal(SIGINT);
    CHECK(recorder.wait(Milliseconds(2000)) == 1);
    CHECK_MESSAGE(has(recorder.errors(), "the file was not completed"), recorder.errors());
    const auto reported = nlohmann::json::parse(recorder.output());
    CHECK(reported["dropped"] > 0);
    CHECK(has(reported["trouble"], "File too large"));
    CHECK(size_of(file) <= limit);
    const Content left = read_whole(file, true);
    CHECK(left.messages >= before);
    CHECK(left.messages == reported["messages"]);
    CHECK(run({program("plabctl"), "recover", file, "-o", saved}).code == 5);
    CHECK(read_whole(saved, true).messages == left.messages);
    // One that is full from the beginning.
    const Outcome none = control(server, {"record", "--overwrite", "-o", "/dev/full"});
    CHECK(none.code == 1);
    CHECK_MESSAGE(has(none.errors, "No space left on device"), none.errors);
}

TEST_CASE("a disk that accepts data again: the file is complete except for its gap, and the exit code shows that")
{
    const Server server(kScene, {"--rate", "real", "--states", "all"});
    const std::string file = fresh("again.mcap");
    Process recorder = record(server, file);
    REQUIRE_MESSAGE(comes_true([&] { return size_of(file) > 20'000; }), recorder.errors());
    limit_files(recorder, size_of(file) + 700);
    REQUIRE_MESSAGE(recorder.wait_for("retrying", kLong), recorder.errors());
    limit_files(recorder, RLIM_INFINITY);
    REQUIRE_MESSAGE(recorder.wait_for("the disk accepts data again", kLong), recorder.errors());
    const auto then = size_of(file);
    REQUIRE(comes_true([&] { return size_of(file) > then + 10'000; }));
    recorder.signal(SIGINT);
    CHECK(recorder.wait(Milliseconds(2000)) == 5);
    const auto reported = nlohmann::json::parse(recorder.output());
    CHECK_MESSAGE(has(recorder.errors(), "messages are not in the file: "), recorder.errors());
    const Content whole = read_whole(file, true);
    CHECK(whole.is_closed);
    CHECK(whole.messages == reported["messages"]);
    const Outcome info = run({program("plabctl"), "--json", "info", file});
    std::uint64_t missing = 0;
    const auto summary = nlohmann::json::parse(info.output);
    for (const auto& gap : summary["gaps"]) missing += gap["messages"].get<std::uint64_t>();
    // Gaps of both kinds: messages that the disk did not accept, and messages that a busy machine lost on the bus.
    CHECK(missing == reported["dropped"].get<std::uint64_t>() + reported["missing"].get<std::uint64_t>());
    CHECK(reported["dropped"] > 0);
}
