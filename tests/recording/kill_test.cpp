// A process that records is killed: everything that it wrote at least 20 ms before is in the file, which is otherwise undamaged.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <new>
#include <random>
#include <thread>

#include "idl/recording/reader.h"
#include "idl/recording/recovery.h"
#include "idl/recording/writer.h"

using namespace plab::recording;
using namespace std::chrono_literals;

namespace
{

constexpr int kKills = 100;
constexpr std::size_t kMostMessages = 10'000;

/// The progress of the killed process, in memory that outlives it.
struct Diary
{
    std::atomic<std::uint64_t> messages{0};              ///< handed to the writer
    std::atomic<std::int64_t> alive_ns{0};               ///< when it was last idle
    std::array<std::int64_t, kMostMessages> written_ns;  ///< when each message was handed over
};

class SharedDiary
{
public:
    SharedDiary() : memory_(::mmap(nullptr, sizeof(Diary), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))
    {
        REQUIRE(memory_ != MAP_FAILED);
        new (memory_) Diary;
    }
    SharedDiary(const SharedDiary&) = delete;
    SharedDiary& operator=(const SharedDiary&) = delete;
    ~SharedDiary() { ::munmap(memory_, sizeof(Diary)); }
    Diary* operator->() { return static_cast<Diary*>(memory_); }
    Diary& operator*() { return *static_cast<Diary*>(memory_); }

private:
    void* memory_;
};

std::int64_t ns_of(Clock::time_point t) { return t.time_since_epoch().count(); }

/// Records four messages each millisecond, until it is killed.
[[noreturn]] void record(const std::string& path, Diary& diary)
{
    auto writer = McapWriter::create(path, {}, Overwrite::Yes).take();
    const auto channel = writer.add_channel({0, 0, "numbers", "raw", {}}).take();
    for (std::uint64_t n = 0; n < kMostMessages; ++n)
    {
        const auto now = Clock::now();
        std::array<std::uint8_t, 256> data{};
        std::memcpy(data.data(), &n, sizeof n);
        diary.written_ns[n] = ns_of(now);
        diary.messages.store(n + 1);
        (void)writer.write({channel, 0, n, 0, data}, now);
        writer.tick(now);
        diary.alive_ns.store(ns_of(now));
        if (n % 4 == 3) std::this_thread::sleep_for(1ms);
    }
    ::_exit(1);  // it was not killed
}

/// Messages of the file, which must be 0, 1, 2, ... without a gap.
std::uint64_t count_messages(const std::string& path)
{
    auto reader = McapReader::open(path);
    REQUIRE(reader);
    CHECK(reader->index().troubles.empty());
    std::uint64_t n = 0;
    auto messages = reader->messages();
    for (auto next = messages.next();; next = messages.next(), ++n)
    {
        REQUIRE(next);
        if (!*next) return n;
        std::uint64_t number = 0;
        std::memcpy(&number, (*next)->message.data.data(), sizeof number);
        REQUIRE(number == n);
    }
}

}  // namespace

TEST_CASE("killed at a random time, a hundred times: at most 20 ms are lost")
{
    const auto folder = std::filesystem::temp_directory_path() / ("plab_kill_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const std::string path = folder / "killed.mcap", mended = folder / "mended.mcap";
    std::mt19937 random(3);
    std::int64_t longest = 0;
    for (int i = 0; i < kKills; ++i)
    {
        CAPTURE(i);
        SharedDiary diary;
        const pid_t child = ::fork();
        if (child == 0) record(path, *diary);
        REQUIRE(child > 0);
        while (diary->messages.load() == 0) std::this_thread::sleep_for(1ms);
        std::this_thread::sleep_for(std::chrono::microseconds(20'000 + random() % 60'000));
        ::kill(child, SIGKILL);
        int status = 0;
        REQUIRE(::waitpid(child, &status, 0) == child);
        REQUIRE(WIFSIGNALED(status));

        const std::uint64_t there = count_messages(path);
        REQUIRE(there <= diary->messages.load());
        // By the clock of the killed process: the age of the lost messages when the process was last known to run.
        const std::int64_t lost = there == diary->messages.load() ? 0 : diary->alive_ns.load() - diary->written_ns[there];
        CHECK(lost < 20'000'000);
        longest = std::max(longest, lost);
        auto report = recover(path, mended, Overwrite::Yes);
        REQUIRE(report);
        CHECK(report->messages == there);
        CHECK(report->verdict == (there > 0 ? Verdict::SomethingLost : Verdict::NothingUsable));
        if (there > 0) CHECK(count_messages(mended) == there);
    }
    CHECK(longest > 0);
    MESSAGE("longest loss ", static_cast<double>(longest) * 1e-6, " ms");
    std::filesystem::remove_all(folder);
}
