// Real files: names, short writes, limits of size.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "idl/recording/recovery.h"
#include "sample_file.h"

using namespace plab::recording;
using namespace plab::recording::test;

namespace
{

/// A folder that is removed at the end of the test.
class Folder
{
public:
    Folder() : path_(std::filesystem::temp_directory_path() / ("plab_recording_" + std::to_string(::getpid())))
    {
        std::filesystem::create_directories(path_);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { std::filesystem::remove_all(path_); }
    std::string operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

/// Files cannot grow beyond `bytes` during the lifetime of this: as on a full disk, a write is short and the next one fails.
class SizeLimit
{
public:
    explicit SizeLimit(rlim_t bytes) : handler_(::signal(SIGXFSZ, SIG_IGN))
    {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limited{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limited);
    }
    SizeLimit(const SizeLimit&) = delete;
    SizeLimit& operator=(const SizeLimit&) = delete;
    ~SizeLimit()
    {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        ::signal(SIGXFSZ, handler_);
    }

private:
    void (*handler_)(int);
    rlimit before_{};
};

std::uint64_t put(McapWriter& writer, ChannelId channel, int chunks)
{
    std::uint64_t taken = 0;
    for (int i = 0; i < chunks; ++i)
    {
        std::string data(4000, 'a');
        for (std::size_t k = 0; k < data.size(); ++k) data[k] = static_cast<char>((k * 7919 + static_cast<std::size_t>(i) * 104729) % 251);
        taken += writer.write({channel, 0, static_cast<std::uint64_t>(i), 0, view_of(data)}, {}) ? 1 : 0;
        writer.flush();
    }
    return taken;
}

}  // namespace

TEST_CASE("an existing file is not overwritten unless that is requested")
{
    const Folder folder;
    const std::string path = folder / "run.mcap";
    CHECK(McapWriter::create(path).take().close());
    const auto size = std::filesystem::file_size(path);
    CHECK(McapWriter::create(path).error().text() == path + ": cannot create the file: File exists");
    CHECK(std::filesystem::file_size(path) == size);
    CHECK(McapWriter::create(path, {}, Overwrite::Yes).take().close());
    CHECK(McapReader::open(path));
    CHECK(McapWriter::create(folder / "none/run.mcap").error().text() ==
          folder / "none/run.mcap: cannot create the file: No such file or directory");
}

TEST_CASE("a file that cannot grow: recording degrades, reports that, and continues when there is room")
{
    const Folder folder;
    const std::string path = folder / "full.mcap";
    WriterOptions options;
    options.compression = Compression::None;
    auto writer = McapWriter::create(path, options).take();
    const auto channel = writer.add_channel({0, 0, "t", "text", {}}).take();
    {
        const SizeLimit limit(20'000);
        CHECK(put(writer, channel, 10) < 10);
        REQUIRE(writer.trouble());
        CHECK(writer.trouble()->text() == path + ": cannot write: File too large");
        CHECK(writer.dropped().messages == 6);
        // As after a crash at this point: a part of a chunk at the end.
        CHECK(read_all(*McapReader::open(path)).lines.size() == 4);
        CHECK(std::filesystem::file_size(path) == 20'000);
        // There is room for a note, but not for a chunk.
        CHECK(writer.retry());
        CHECK(put(writer, channel, 1) == 1);
        REQUIRE(writer.trouble());
        CHECK(writer.dropped().messages == 7);
    }
    CHECK(writer.retry());
    CHECK(put(writer, channel, 5) == 5);
    CHECK(writer.close());
    auto reader = McapReader::open(path);
    REQUIRE(reader);
    CHECK(reader->index().has_summary);
    CHECK(read_all(*reader).lines.size() == 9);
    REQUIRE(reader->index().metadata.size() == 2);
    CHECK(reader->metadata(reader->index().metadata[0])->values.at("messages") == "6");
    CHECK(reader->metadata(reader->index().metadata[1])->values.at("messages") == "1");
}

TEST_CASE("recovery by name: a new file, never the file itself, none without content")
{
    const Folder folder;
    const SampleFile file(Compression::Zstd, 5, false);
    const std::string in = folder / "cut.mcap", out = folder / "good.mcap";
    std::ofstream(in, std::ios::binary)
        .write(reinterpret_cast<const char*>(file.bytes.data()), static_cast<std::streamsize>(file.bytes.size()));
    CHECK(recover(in, in, Overwrite::Yes).error().text() == in + ": is the recording itself; give another file");
    auto report = recover(in, out);
    REQUIRE(report);
    CHECK(exit_code(report->verdict) == 5);
    CHECK(read_all(*McapReader::open(out)).lines == by_time(file.lines));
    CHECK(recover(in, out).error().text() == out + ": cannot create the file: File exists");
    std::filesystem::resize_file(in, 40);
    auto nothing = recover(in, folder / "nothing.mcap");
    REQUIRE(nothing);
    CHECK(exit_code(nothing->verdict) == 1);
    CHECK(!std::filesystem::exists(folder / "nothing.mcap"));
}
