// A file of 1 GB: the time of opening it and of seeking, and that the correct messages are found.
#include <doctest/doctest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>

#include "idl/recording/cdr.h"
#include "idl/recording/reader.h"
#include "idl/recording/topic_file.h"
#include "idl/recording/writer.h"
#include "walking_frames.h"

using namespace plab::recording;

namespace
{

constexpr std::uint64_t kMillisecond = 1'000'000;

/// Removed when the test ends.
struct LargeFile
{
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("plab_seek_" + std::to_string(::getpid()) + ".mcap");
    std::uint64_t end = 0;

    LargeFile() { write(); }
    LargeFile(const LargeFile&) = delete;
    LargeFile& operator=(const LargeFile&) = delete;
    ~LargeFile() { std::filesystem::remove(path); }

private:
    void write()
    {
        WriterOptions options;
        options.compression = Compression::Lz4;
        auto writer = McapWriter::create(path, options, Overwrite::Yes).take();
        const auto schema = writer.add_schema(*schema_of<plab_v2_Frame>()).take();
        const auto states = writer.add_channel(channel_of<plab_v2_Frame>(schema)).take();
        const auto rare = writer.add_channel({0, 0, "rare", "text", {}}).take();
        plab::test::WalkingFrames frames(1000, 1000, 1e-3);
        Encoder encoder;
        Clock::time_point now{};
        for (std::uint64_t i = 0; writer.file_size() < 1'000'000'000; ++i, now += std::chrono::milliseconds(1), end += kMillisecond)
        {
            if (i % 1000 == 0) REQUIRE(writer.write({rare, 0, i * kMillisecond, 0, {}}, now));
            REQUIRE(writer.write({states, 0, i * kMillisecond, 0, *encoder.encode(frames.next())}, now));
        }
        REQUIRE(writer.close());
    }
};

/// Seconds that `work` takes.
template <class Work>
double time_of(Work&& work)
{
    const auto begin = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

TEST_CASE("opening a file of 1 GB and seeking to any time in it take less than a second")
{
    const LargeFile file;
    Decoder decoder;
    Sample<plab_v2_Frame> frame;
    for (int i = 0; i < 10; ++i)
    {
        const std::uint64_t time = file.end / 10 * static_cast<std::uint64_t>(i) + kMillisecond / 2;
        const double seconds = time_of(
            [&]
            {
                auto reader = McapReader::open(file.path);
                REQUIRE(reader);
                REQUIRE(reader->index().has_summary);
                auto found = reader->last_at("plab/states", time);
                REQUIRE(found);
                REQUIRE(*found);
                REQUIRE(decoder.decode((*found)->message.data, frame));
                CHECK((*found)->message.log_time == time / kMillisecond * kMillisecond);
                CHECK(frame->step == static_cast<std::int64_t>(time / kMillisecond) + 1);
                CHECK((*reader->last_at("rare", time))->message.log_time == time / (1000 * kMillisecond) * 1000 * kMillisecond);
                auto next = reader->messages({{"plab/states"}, time}).next();
                REQUIRE(next);
                CHECK((*next)->message.log_time == (time + kMillisecond - 1) / kMillisecond * kMillisecond);
            });
        CAPTURE(time);
        CHECK(seconds < 1.0);
        MESSAGE("opened, and sought ", static_cast<double>(time) * 1e-9, " s, in ", seconds * 1e3, " ms");
    }
    // A truncated file needs a scan.
    std::filesystem::resize_file(file.path, std::filesystem::file_size(file.path) - 1'000'000);
    const double seconds = time_of(
        [&]
        {
            auto reader = McapReader::open(file.path);
            REQUIRE(reader);
            CHECK(!reader->index().has_summary);
            CHECK(reader->last_at("plab/states", file.end / 2)->has_value());
        });
    CHECK(seconds < 5.0);
    MESSAGE("truncated: opened, and sought its middle, in ", seconds * 1e3, " ms");
}
