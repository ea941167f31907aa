// Prints figures of recordings: the cost of writing with each compression, the compressed size, the time of reading and
// seeking. CSV on standard output: name, unit, value. Not a test: timings are not checked.
//
//   bench_recording [FOLDER]    FOLDER: for the files, up to 2 GB; the current one by default. They are removed.
#include <ctime>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "idl/recording/cdr.h"
#include "idl/recording/reader.h"
#include "idl/recording/recovery.h"
#include "idl/recording/topic_file.h"
#include "idl/recording/writer.h"
#include "walking_frames.h"

using namespace plab;
using namespace plab::recording;

namespace
{

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// CPU time of this thread, s.
double cpu()
{
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void print(const std::string& name, const char* unit, double value)
{
    std::printf("%s,%s,%.4g\n", name.c_str(), unit, value);
    std::fflush(stdout);
}

template <class T>
T must(Result<T> result)
{
    if (result) return result.take();
    std::fprintf(stderr, "bench_recording: %s\n", result.error().text().c_str());
    std::exit(1);
}
void must(Result<void> result)
{
    if (result) return;
    std::fprintf(stderr, "bench_recording: %s\n", result.error().text().c_str());
    std::exit(1);
}

struct Setting
{
    std::string name;
    Compression compression = Compression::None;
    int level = 0;
};

WriterOptions options_of(const Setting& setting)
{
    WriterOptions options;
    options.compression = setting.compression;
    options.level = setting.level;
    return options;
}

/// A minute of frames, made beforehand, and written as fast as possible with times as if they came at `rate`.
void write_frames(const std::string& path, const Setting& setting, const std::string& scene, std::size_t moving, int rate, int count)
{
    test::WalkingFrames frames(1000, moving, 1.0 / rate);
    Encoder encoder;
    std::vector<Bytes> samples;
    for (int i = 0; i < count; ++i)
    {
        const ByteView bytes = must(encoder.encode(frames.next()));
        samples.emplace_back(bytes.begin(), bytes.end());
    }
    McapWriter writer = must(McapWriter::create(path, options_of(setting), Overwrite::Yes));
    const auto schema = must(writer.add_schema(must(schema_of<plab_v2_Frame>())));
    const auto channel = must(writer.add_channel(channel_of<plab_v2_Frame>(schema)));
    const double begin = cpu();
    Clock::time_point now{};
    std::uint64_t time = 0;
    for (const Bytes& sample : samples)
    {
        (void)writer.write({channel, 0, time, time, sample}, now);
        now += std::chrono::nanoseconds(1'000'000'000 / rate);
        time += 1'000'000'000ull / static_cast<std::uint64_t>(rate);
    }
    must(writer.close());
    const double used = cpu() - begin;
    const double raw = static_cast<double>(samples.size() * samples[0].size());
    const double size = static_cast<double>(std::filesystem::file_size(path));
    const std::string name = scene + " " + setting.name;
    print("write " + name, "MB/s of CPU time", raw / used * 1e-6);
    print("write " + name, "us per frame", used / count * 1e6);
    print("ratio " + name, "raw / file", raw / size);
    print("size " + name, "bytes per object and frame", size / count / 1000);
}

void write_small(const std::string& path, const Setting& setting)
{
    constexpr int kCount = 1'000'000;
    McapWriter writer = must(McapWriter::create(path, options_of(setting), Overwrite::Yes));
    const auto channel = must(writer.add_channel({0, 0, "plab/hashes", "cdr", {}}));
    Bytes sample(48, 0);
    const double begin = cpu();
    Clock::time_point now{};
    for (std::uint64_t i = 0; i < kCount; ++i, now += std::chrono::milliseconds(1))
    {
        const std::uint64_t hash = (i + 1) * 0x9e3779b97f4a7c15u;
        std::memcpy(sample.data() + 40, &hash, sizeof hash);
        (void)writer.write({channel, 0, i * 1'000'000, i, sample}, now);
    }
    must(writer.close());
    print("write 48 bytes at 1 kHz " + setting.name, "ns per message", (cpu() - begin) / kCount * 1e9);
    print("size 48 bytes at 1 kHz " + setting.name, "bytes per message", static_cast<double>(std::filesystem::file_size(path)) / kCount);
}

void encode_frames()
{
    test::WalkingFrames frames(1000, 1000, 1e-3);
    Encoder encoder;
    Decoder decoder;
    Sample<plab_v2_Frame> back;
    constexpr int kCount = 300;
    double encoding = 0, decoding = 0;
    for (int i = 0; i < kCount; ++i)
    {
        const auto& frame = frames.next();
        const double begin = cpu();
        const ByteView bytes = must(encoder.encode(frame));
        const double middle = cpu();
        must(decoder.decode(bytes, back));
        encoding += middle - begin;
        decoding += cpu() - middle;
    }
    print("encode a frame of 1000 bodies", "us", encoding / kCount * 1e6);
    print("decode a frame of 1000 bodies", "us", decoding / kCount * 1e6);
}

/// 1 GB of frames at 1 kHz: opening, seeking, reading all, scanning, recovering.
void read_large(const std::string& folder)
{
    const std::string path = folder + "/large.mcap", cut = folder + "/cut.mcap", recovered = folder + "/recovered.mcap";
    write_frames(path, {"lz4", Compression::Lz4, 0}, "1 GB at 1 kHz", 1000, 1000, 100);  // warms the disk's cache of metadata
    test::WalkingFrames frames(1000, 1000, 1e-3);
    Encoder encoder;
    {
        McapWriter writer = must(McapWriter::create(path, options_of({"zstd", Compression::Zstd, 1}), Overwrite::Yes));
        const auto schema = must(writer.add_schema(must(schema_of<plab_v2_Frame>())));
        const auto channel = must(writer.add_channel(channel_of<plab_v2_Frame>(schema)));
        Clock::time_point now{};
        while (writer.file_size() < 1'000'000'000)
        {
            (void)writer.write({channel, 0, frames.log_time(), 0, must(encoder.encode(frames.next()))}, now);
            now += std::chrono::milliseconds(1);
        }
        must(writer.close());
    }
    auto begin = Clock::now();
    McapReader reader = must(McapReader::open(path));
    print("open 1 GB", "ms", seconds_since(begin) * 1e3);
    print("open 1 GB", "chunks", static_cast<double>(reader.index().chunks.size()));
    double worst = 0;
    for (std::uint64_t i = 0; i < 50; ++i)
    {
        begin = Clock::now();
        (void)must(reader.last_at("plab/states", frames.log_time() / 50 * i));
        worst = std::max(worst, seconds_since(begin));
    }
    print("last frame at a time, worst of 50", "ms", worst * 1e3);
    begin = Clock::now();
    Cursor all = reader.messages();
    double bytes = 0;
    for (auto next = must(all.next()); next; next = must(all.next())) bytes += static_cast<double>(next->message.data.size());
    print("read all", "MB/s", bytes / seconds_since(begin) * 1e-6);

    std::filesystem::rename(path, cut);
    std::filesystem::resize_file(cut, std::filesystem::file_size(cut) - 5'000'000);
    begin = Clock::now();
    (void)must(McapReader::open(cut));
    print("open 1 GB that was cut", "ms", seconds_since(begin) * 1e3);
    begin = Clock::now();
    (void)must(recover(cut, recovered, Overwrite::Yes));
    print("recover 1 GB", "s", seconds_since(begin));
    std::filesystem::remove(cut);
    std::filesystem::remove(recovered);
}

}  // namespace

int main(int count, char** arguments)
{
    const std::string folder = count > 1 ? arguments[1] : ".";
    const std::string path = folder + "/bench_recording.mcap";
    const Setting settings[]{{"none", Compression::None, 0},
                             {"lz4", Compression::Lz4, 0},
                             {"zstd 1", Compression::Zstd, 1},
                             {"zstd 3", Compression::Zstd, 3},
                             {"zstd 6", Compression::Zstd, 6}};
    encode_frames();
    for (const Setting& setting : settings)
    {
        write_frames(path, setting, "all moving 60 Hz", 1000, 60, 600);
        write_frames(path, setting, "all moving 1 kHz", 1000, 1000, 600);
        write_frames(path, setting, "a tenth moving 60 Hz", 100, 60, 600);
        write_small(path, setting);
    }
    std::filesystem::remove(path);
    read_large(folder);
    return 0;
}
