// Ctrl-C: whatever reads a recording ends soon, reports how far it was, and leaves no incomplete file behind.
#include <doctest/doctest.h>
#include <signal.h>

#include <filesystem>
#include <thread>

#include "control/recording/analysis/curves.h"
#include "control/recording/analysis/export.h"
#include "control/recording/analysis/report.h"
#include "idl/recording/recovery.h"
#include "made_recording.h"
#include "support/process.h"
#include "support/text.h"

using namespace plab;
using namespace plab::analysis;
using namespace plab::test;

namespace
{

/// Continues for this number of reads of the source.
recording::Watch after(int reads)
{
    return [reads](double share) mutable
    {
        CHECK(share >= 0);
        CHECK(share <= 1);
        return reads-- > 0;
    };
}

/// The number of reads for the whole file.
int reads_of(const std::string& file)
{
    int reads = 0;
    auto log = Log::open(file,
                         [&](double)
                         {
                             ++reads;
                             return true;
                         });
    REQUIRE(log.ok());
    REQUIRE(summary_of(*log).ok());
    CHECK(!log->is_interrupted());
    return reads;
}

}  // namespace

TEST_CASE("after the watch has returned false nothing more is read, and no file is left")
{
    const std::string file = make_recording("interrupted.mcap", {.steps = 20000});
    const int all = reads_of(file);
    REQUIRE(all > 20);
    for (const int reads : {all / 2, all - 2})
    {
        auto log = Log::open(file, after(reads));
        REQUIRE(log.ok());
        const std::string out = fresh_path("interrupted.csv"), json = fresh_path("interrupted.jsonl");
        const auto tables = export_csv(*log, {.out = out});
        REQUIRE(!tables);
        CHECK(has(tables.error().text(), "interrupted"));
        CHECK(log->is_interrupted());
        CHECK(!export_json(*log, {.out = json}));
        for (const std::string& none : {out, json})
        {
            CHECK(!std::filesystem::exists(none));
            CHECK(!std::filesystem::exists(none + ".part"));
        }
    }
    CHECK(!Log::open(file, after(0)));
}

TEST_CASE("recover that is interrupted leaves no new file, whenever that is")
{
    const std::string file = make_recording("interrupted_cut.mcap", {.steps = 3000, .is_closed = false});
    const std::string out = fresh_path("interrupted_recovered.mcap");
    int reads = 0;
    const auto count = [&reads](double)
    {
        ++reads;
        return true;
    };
    REQUIRE(recording::recover(file, out, recording::Overwrite::No, {}, count));
    CHECK(std::filesystem::remove(out));
    REQUIRE(reads > 10);
    for (int n = 0; n < reads; n += std::max(1, reads / 20))
    {
        const auto stopped = recording::recover(file, out, recording::Overwrite::No, {}, after(n));
        REQUIRE_MESSAGE(!stopped, n << " of " << reads);
        CHECK(has(stopped.error().text(), "interrupted"));
        CHECK(!std::filesystem::exists(out));
    }
}

TEST_CASE("every command on a recording ends at Ctrl-C with 130 and at SIGTERM with 143, and reports how far it was")
{
    const std::string file = make_recording("interrupted_big.mcap", {.steps = 60000, .compression = recording::Compression::Zstd});
    const std::string plabctl = program("plabctl"), out = fresh_path("interrupted_out");
    const std::vector<std::vector<std::string>> commands{{"info", file},
                                                         {"export", file, "--csv", "-o", out + ".csv"},
                                                         {"export", file, "--json", "-o", out + ".jsonl"},
                                                         {"diff", file, file},
                                                         {"plot", file, "-q", "red.speed", "-o", out + ".svg"},
                                                         {"report", file, "-o", out + ".html"},
                                                         {"log", file},
                                                         {"recover", file, "-o", out + ".mcap"}};
    int number = 0;
    for (const std::vector<std::string>& arguments : commands)
    {
        const int signal = number++ % 2 == 0 ? SIGINT : SIGTERM;
        // Too early is before it begins, too late is after it has finished: on a machine of any speed one of these delays is in
        // between.
        bool is_seen = false;
        for (const int delay : {40, 80, 20, 160, 10, 320, 640})
        {
            std::vector<std::string> command{plabctl};
            command.insert(command.end(), arguments.begin(), arguments.end());
            Process process(command);
            std::this_thread::sleep_for(Milliseconds(delay));
            process.signal(signal);
            const int code = process.wait(Milliseconds(5000));
            const bool is_ended = code == 0 || code == 128 + signal;
            CHECK_MESSAGE(is_ended, arguments[0] << " ended with " << code << "\n" << process.errors());
            is_seen = code == 128 + signal && has(process.errors(), "plabctl: interrupted: " + arguments[0]);
            if (code != 0)
                for (const char* ending : {".csv", ".jsonl", ".svg", ".html", ".mcap", ".csv.part", ".jsonl.part", ".html.part"})
                    CHECK_MESSAGE(!std::filesystem::exists(out + ending), arguments[0] << " left " << ending);
            for (const char* ending : {".csv", ".jsonl", ".svg", ".html", ".mcap"}) std::filesystem::remove(out + ending);
            if (is_seen) break;
        }
        CHECK_MESSAGE(is_seen, arguments[0] << " was never interrupted");
    }
}
