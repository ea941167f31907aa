// A warm writer takes messages without allocating; a chunk costs a few allocations, whatever its content.
#include <doctest/doctest.h>

#include "sample_file.h"
#include "support/allocation_counter.h"

using namespace plab::recording;
using namespace plab::recording::test;
using namespace std::chrono_literals;

namespace
{

/// Takes everything and keeps nothing.
class Void final : public Sink
{
public:
    plab::Result<void> append(ByteView) override { return {}; }
    plab::Result<void> truncate(std::uint64_t) override { return {}; }
    plab::Result<void> sync() override { return {}; }
    plab::Result<void> close() override { return {}; }
};

}  // namespace

TEST_CASE("a warm writer allocates nothing for a message, and little for a chunk")
{
    for (const Compression compression : {Compression::None, Compression::Lz4, Compression::Zstd})
    {
        CAPTURE(static_cast<int>(compression));
        WriterOptions options;
        options.compression = compression;
        auto writer = McapWriter::open(std::make_unique<Void>(), options).take();
        const auto channel = writer.add_channel({0, 0, "t", "text", {}}).take();
        const std::string data(500, 'x');
        Clock::time_point now{};
        std::uint64_t time = 0;
        const auto write_chunk = [&](int messages)
        {
            for (int i = 0; i < messages; ++i) CHECK_UNARY(writer.write({channel, 0, ++time, 0, view_of(data)}, now));
        };
        const auto close_chunk = [&]
        {
            now += 20ms;
            writer.tick(now);
        };
        for (int i = 0; i < 5; ++i) write_chunk(100), close_chunk();

        write_chunk(1);
        long before = plab::test::allocations;
        for (int i = 0; i < 99; ++i) (void)writer.write({channel, 0, ++time, 0, view_of(data)}, now);
        CHECK(plab::test::allocations - before == 0);
        before = plab::test::allocations;
        close_chunk();
        CHECK(plab::test::allocations - before <= 4);
    }
}
