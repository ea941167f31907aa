// Full, broken or slow disks under a recording that is written by a thread of its own.
#include "idl/recording/async_writer.h"

#include <doctest/doctest.h>

#include <atomic>

#include "idl/recording/metadata.h"
#include "idl/recording/reader.h"

using namespace plab;
using namespace plab::recording;
using namespace std::chrono_literals;

namespace
{

/// What a test does to the disk during writing.
struct Disk
{
    std::mutex mutex;
    Bytes bytes;
    std::size_t capacity = std::numeric_limits<std::size_t>::max();  ///< beyond it: as on a full disk, a short write, then an error
    bool is_broken = false;                                          ///< every call fails, truncate() too
    std::atomic<bool> is_stuck{false};                               ///< a write does not return

    Bytes copy()
    {
        const std::lock_guard lock(mutex);
        return bytes;
    }
};

class DiskSink final : public Sink
{
public:
    explicit DiskSink(std::shared_ptr<Disk> disk) : disk_(std::move(disk)) {}
    Result<void> append(ByteView more) override
    {
        while (disk_->is_stuck) std::this_thread::sleep_for(1ms);
        const std::lock_guard lock(disk_->mutex);
        if (disk_->is_broken) return broken();
        const std::size_t room = disk_->capacity - std::min(disk_->capacity, disk_->bytes.size());
        const ByteView part = more.first(std::min(room, more.size()));
        disk_->bytes.insert(disk_->bytes.end(), part.begin(), part.end());
        if (part.size() < more.size()) return reason("run.mcap: cannot write: No space left on device");
        return {};
    }
    Result<void> truncate(std::uint64_t size) override
    {
        const std::lock_guard lock(disk_->mutex);
        if (disk_->is_broken) return broken();
        disk_->bytes.resize(size);
        return {};
    }
    Result<void> sync() override { return answer(); }
    Result<void> close() override { return answer(); }

private:
    static Result<void> broken() { return reason("run.mcap: cannot write: Input/output error"); }
    Result<void> answer() const
    {
        const std::lock_guard lock(disk_->mutex);
        return disk_->is_broken ? broken() : Result<void>();
    }

    std::shared_ptr<Disk> disk_;
};

/// A number, as a sample of 256 bytes; or the text of an attachment.
struct Item
{
    std::uint64_t number = 0;
    std::string blueprint;
};

std::uint64_t write_item(TopicFile& file, const Item& entry)
{
    const std::uint64_t log_time = entry.number * 1'000'000;
    Bytes data(256, 0);
    std::memcpy(data.data(), &entry.number, sizeof entry.number);
    if (entry.blueprint.empty())
        file.write(wire::topic_of<plab_v2_Frame>(), data, {log_time, 0, Clock::now()});
    else
        file.attach(log_time, "blueprint.xml", "text/xml", entry.blueprint);
    return log_time;
}

/// A writer that receives numbers, one each millisecond.
class Fed
{
public:
    explicit Fed(std::size_t most_waiting_bytes = 64u << 20)
    {
        AsyncWriterOptions options;
        options.file = "no such folder/run.mcap", options.compression = Compression::None;
        options.most_waiting_bytes = most_waiting_bytes;
        options.notice = [this](Notice notice, const std::string&) { notices.push_back(notice); };
        auto opened = open_writer(std::make_unique<DiskSink>(disk), options);
        REQUIRE(opened);
        REQUIRE(opened->add_metadata({"plab", {{"format", "2"}}}));
        writer = std::make_unique<AsyncWriter<Item>>(opened.take(), options, write_item);
    }
    void put_one(Weight weight = Weight::Essential) { (void)writer->push({offered++, ""}, 256 + sizeof(Item), weight); }
    void put(int count)
    {
        for (int i = 0; i < count; ++i)
        {
            put_one();
            std::this_thread::sleep_for(1ms);
        }
    }
    /// Waits until `is_so` holds for the progress; false after 3 s.
    template <class Condition>
    bool comes_to(Condition is_so)
    {
        for (int i = 0; i < 600 && !is_so(writer->progress()); ++i) std::this_thread::sleep_for(5ms);
        return is_so(writer->progress());
    }

    std::shared_ptr<Disk> disk = std::make_shared<Disk>();
    std::vector<Notice> notices;  ///< to be read after close()
    std::unique_ptr<AsyncWriter<Item>> writer;
    std::uint64_t offered = 0;
};

/// The present content of the disk, as a reader finds it.
struct OnDisk
{
    explicit OnDisk(Disk& disk) : bytes(disk.copy()), reader(open(bytes)) {}
    static McapReader open(const Bytes& bytes)
    {
        auto reader = McapReader::open(std::make_unique<MemorySource>(bytes));
        REQUIRE_MESSAGE(reader.ok(), reader.error().text());
        return reader.take();
    }
    Bytes bytes;
    McapReader reader;
};

std::vector<std::uint64_t> numbers_in(const McapReader& reader)
{
    std::vector<std::uint64_t> out;
    Cursor messages = reader.messages();
    for (auto next = messages.next();; next = messages.next())
    {
        REQUIRE(next);
        if (!*next) return out;
        std::uint64_t number = 0;
        std::memcpy(&number, (*next)->message.data.data(), sizeof number);
        out.push_back(number);
    }
}

/// 0, 1, 2, ... without those that are missing.
bool ascends(const std::vector<std::uint64_t>& numbers)
{
    return std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) == numbers.end();
}

/// Messages that the file itself says are missing.
std::uint64_t reported_missing(const McapReader& reader)
{
    std::uint64_t out = 0;
    for (const auto& at : reader.index().metadata)
        if (const auto record = reader.metadata(at); record && record->name == "gap") out += std::stoull(record->values.at("messages"));
    return out;
}

}  // namespace

TEST_CASE("a disk that fills up and stays full: this is soon reported at the end, and everything before is complete")
{
    Fed fed;
    fed.put(100);
    REQUIRE(fed.comes_to([](const WriteProgress& p) { return p.messages == 100; }));
    {
        const std::lock_guard lock(fed.disk->mutex);
        fed.disk->capacity = fed.disk->bytes.size() + 100;  // less than a chunk: a short write
    }
    fed.put(200);
    CHECK(fed.comes_to([](const WriteProgress& p) { return p.trouble && p.dropped > 0; }));
    CHECK(fed.writer->progress().trouble->text() == "run.mcap: cannot write: No space left on device");
    CHECK(numbers_in(OnDisk(*fed.disk).reader).size() == 100);

    const auto begin = Clock::now();
    const auto closed = fed.writer->close();
    CHECK(Clock::now() - begin < 1s);
    REQUIRE(!closed);
    CHECK(closed.error().text() == "run.mcap: cannot write: No space left on device");
    const WriteProgress end = fed.writer->progress();
    CHECK(end.messages == 100);
    CHECK(end.messages + end.dropped == fed.offered);
    CHECK(!end.is_ended);
    const OnDisk found(*fed.disk);
    const McapReader& reader = found.reader;
    const auto numbers = numbers_in(reader);
    CHECK(numbers.size() == 100);
    CHECK(ascends(numbers));
    CHECK(!reader.index().is_closed);
}

TEST_CASE("a disk that has room for all messages and none for the end of the file: nothing is lost, and that is an error")
{
    Fed fed;
    fed.put(100);
    REQUIRE(fed.comes_to([](const WriteProgress& p) { return p.messages == 100; }));
    {
        const std::lock_guard lock(fed.disk->mutex);
        fed.disk->capacity = fed.disk->bytes.size() + 50;
    }
    CHECK(!fed.writer->close());
    const WriteProgress end = fed.writer->progress();
    CHECK(!end.is_ended);
    CHECK(end.dropped == 0);
    REQUIRE(end.last_trouble);
    CHECK(end.last_trouble->text() == "run.mcap: cannot write: No space left on device");
    const OnDisk found(*fed.disk);
    CHECK(!found.reader.index().is_closed);
    CHECK(numbers_in(found.reader).size() == 100);
}

TEST_CASE("a disk that fails for a while: the file continues and notes its gap, and the gap is reported at the end")
{
    Fed fed;
    fed.put(50);
    REQUIRE(fed.comes_to([](const WriteProgress& p) { return p.messages == 50; }));
    const auto set_broken = [&](bool is_broken)
    {
        const std::lock_guard lock(fed.disk->mutex);
        fed.disk->is_broken = is_broken;
    };
    set_broken(true);
    fed.put(60);
    REQUIRE(fed.comes_to([](const WriteProgress& p) { return p.trouble.has_value(); }));
    set_broken(false);
    REQUIRE(fed.comes_to([](const WriteProgress& p) { return !p.trouble; }));
    fed.put(50);
    const auto closed = fed.writer->close();
    REQUIRE_MESSAGE(closed.ok(), closed.error().text());
    const WriteProgress end = fed.writer->progress();
    CHECK(end.is_ended);
    CHECK(end.dropped > 0);
    REQUIRE(end.last_trouble);
    CHECK(end.last_trouble->text() == "run.mcap: cannot write: Input/output error");
    CHECK(end.messages + end.dropped == fed.offered);
    CHECK(std::count(fed.notices.begin(), fed.notices.end(), Notice::Stalled) == 1);
    const OnDisk found(*fed.disk);
    const McapReader& reader = found.reader;
    CHECK(reader.index().is_closed);
    CHECK(reader.index().troubles.empty());
    const auto numbers = numbers_in(reader);
    CHECK(numbers.size() == end.messages);
    CHECK(ascends(numbers));
    CHECK(reported_missing(reader) == end.dropped);
}

TEST_CASE("messages that wait for a disk that works again only at the end are nevertheless in the file")
{
    Fed fed;
    {
        const std::lock_guard lock(fed.disk->mutex);
        fed.disk->is_broken = true;
    }
    fed.put(40);
    REQUIRE(fed.comes_to([](const WriteProgress& p) { return p.trouble.has_value(); }));
    (void)fed.writer->push({0, "<plab/>"}, 8, Weight::Vital);
    fed.put(1);  // wakes the writer, whose next attempt is some time away
    {
        const std::lock_guard lock(fed.disk->mutex);
        fed.disk->is_broken = false;
    }
    const auto closed = fed.writer->close();
    REQUIRE_MESSAGE(closed.ok(), closed.error().text());
    const OnDisk found(*fed.disk);
    const McapReader& reader = found.reader;
    REQUIRE(reader.index().attachments.size() == 1);
    const WriteProgress end = fed.writer->progress();
    CHECK(reported_missing(reader) == end.dropped);
    CHECK(end.dropped + end.messages == fed.offered);
}

TEST_CASE("a disk that does not respond: the recording thread does not wait, and messages without room are counted")
{
    constexpr std::size_t kRoom = 20'000;
    Fed fed(kRoom);
    fed.put(20);
    REQUIRE(fed.comes_to([](const WriteProgress& p) { return p.messages == 20; }));
    fed.disk->is_stuck = true;
    fed.put(30);  // the writer is now blocked in a write
    const auto begin = Clock::now();
    for (int i = 0; i < 200; ++i) fed.put_one();
    CHECK(Clock::now() - begin < 1s);
    const std::uint64_t lost = fed.writer->progress().dropped;
    CHECK(lost > 200 - kRoom / 256);
    CHECK(lost < 230);
    fed.disk->is_stuck = false;
    const auto closed = fed.writer->close();
    REQUIRE_MESSAGE(closed.ok(), closed.error().text());
    const WriteProgress end = fed.writer->progress();
    CHECK(end.messages + end.dropped == fed.offered);
    CHECK(!end.last_trouble);
    CHECK(reported_missing(OnDisk(*fed.disk).reader) == end.dropped);
}

TEST_CASE("without room, details are refused before essential entries, and these before vital ones")
{
    constexpr std::size_t kItem = 256 + sizeof(Item);
    Fed fed(4 * kItem);
    fed.disk->is_stuck = true;
    fed.put(30);  // the writer is now blocked in a write
    fed.put(30);  // and nothing is left for essential entries
    CHECK(!fed.writer->has_room(kItem, Weight::Detail));
    CHECK(!fed.writer->has_room(kItem, Weight::Essential));
    CHECK(fed.writer->has_room(kItem, Weight::Vital));
    const std::uint64_t lost = fed.writer->progress().dropped;
    fed.put_one(Weight::Vital);
    CHECK(fed.writer->progress().dropped == lost);
    fed.disk->is_stuck = false;
    REQUIRE(fed.writer->close());
    const OnDisk found(*fed.disk);
    const auto numbers = numbers_in(found.reader);
    REQUIRE(!numbers.empty());
    CHECK(numbers.back() == fed.offered - 1);
    CHECK(reported_missing(found.reader) == lost);
}
