#include <algorithm>
#include <array>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>

#include "control/console/json.h"
#include "control/recording/commands.h"
#include "control/recording/recorder/recorder.h"
#include "link/numbers.h"
#include "program/progress.h"

namespace plab::cli
{
namespace
{

constexpr const char* kRecordExamples =
    "  plabctl record                                 until Ctrl-C, to lab_2026-11-22_14-05-09.mcap\n"
    "  plabctl record -o run.mcap --until 10          until 10 simulated seconds\n"
    "  plabctl record -o run.mcap -d 60               for a minute\n"
    "  plabctl record -o run.mcap --max-size 100      until the file has 100 MB\n"
    "  plabctl record --state-rate 10 --compression lz4\n"
    "  plabctl record --topics plab/events plab/collisions plab/states\n"
    "Play it: plabctl play FILE. What is in it: plabctl info FILE.\n";

constexpr link::Seconds kSlice(0.1);  // how late Ctrl-C may be seen

struct RecordOptions
{
    recorder::RecorderOptions recorder;
    std::string compression = "zstd";
    std::optional<double> max_megabytes;  ///< of the file: the recording ends there
};

std::string name_with_time(const std::string& server)
{
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    (void)localtime_r(&now, &local);
    std::array<char, 32> text{};
    (void)std::strftime(text.data(), text.size(), "_%Y-%m-%d_%H-%M-%S.mcap", &local);
    return server + text.data();
}

std::string seconds_text(double seconds)
{
    std::array<char, 32> text{};
    (void)std::snprintf(text.data(), text.size(), "%.2f s", seconds);
    return text.data();
}

std::string counts_text(const recorder::Progress& p)
{
    std::string out = std::to_string(p.messages) + " messages, " + bytes_text(p.bytes);
    if (p.missing > 0) out += ", " + std::to_string(p.missing) + " did not arrive";
    if (p.dropped > 0) out += ", " + std::to_string(p.dropped) + " dropped";
    return out;
}

/// Reports a disk that fails, and one that works again.
class TroubleWatch
{
public:
    void update(const Context& c, program::Progress& line, const std::optional<Error>& trouble)
    {
        if (trouble.has_value() == is_reported_) return;
        is_reported_ = trouble.has_value();
        line.clear();
        c.console.say("plabctl: " + (trouble ? printable(trouble->text()) + "; retrying" : std::string("the disk accepts data again")));
    }

private:
    bool is_reported_ = false;
};

recorder::State follow(const Context& c, recorder::Recorder& recorder, const RecordOptions& o)
{
    const std::string& file = o.recorder.writer.file;
    constexpr double kMegabyte = 1e6;
    const auto begin = std::chrono::steady_clock::now();
    const auto is_over = [&]
    {
        const recorder::Progress p = recorder.progress();
        if (c.settings.count && p.messages >= *c.settings.count) return true;
        if (o.max_megabytes && static_cast<double>(p.bytes) >= *o.max_megabytes * kMegabyte) return true;
        return c.settings.duration && link::Seconds(std::chrono::steady_clock::now() - begin).count() >= *c.settings.duration;
    };
    program::Progress line(c.progress_to(), std::chrono::milliseconds(0));
    TroubleWatch watch;
    auto state = recorder::State::Running;
    while (state == recorder::State::Running && !c.stopped() && !is_over())
    {
        state = recorder.step(kSlice);
        const recorder::Progress progress = recorder.progress();
        watch.update(c, line, progress.trouble);
        if (line.is_due()) line.show(file + ": " + seconds_text(recorder.length()) + ", " + counts_text(progress) + "  (Ctrl-C ends)");
    }
    return state;
}

void print_end(const Context& c, const std::string& file, const recorder::Recorder& recorder, const recorder::Progress& p)
{
    if (c.settings.json)
        print(c.console, {{"file", file},
                          {"server", c.session().server()},
                          {"seconds", recorder.length()},
                          {"messages", p.messages},
                          {"bytes", p.bytes},
                          {"missing", p.missing},
                          {"dropped", p.dropped},
                          {"trouble", p.last_trouble ? Json(p.last_trouble->text()) : Json()},
                          {"broken", recorder.broken()}});
    else
        c.console.out(printable(file) + ": " + seconds_text(recorder.length()) + " of server '" + c.session().server() + "', " +
                      counts_text(p) + "\n");
    if (recorder.broken() > 0)
        c.console.say("plabctl: " + std::to_string(recorder.broken()) + " samples did not match the type of their topic, and are left out");
}

/// About a completed file that has gaps.
Exit report_losses(const Context& c, const recorder::Progress& p)
{
    if (p.dropped == 0) return Exit::Done;
    c.console.say("plabctl: " + std::to_string(p.dropped) + " messages are not in the file: " +
                  (p.last_trouble ? printable(p.last_trouble->text()) : std::string("the disk was too slow for the incoming data")));
    return Exit::Lost;
}

/// Topics that plabd --replay needs and that were not requested.
std::string missing_for_replay(const std::vector<std::string>& topics)
{
    std::string out;
    if (topics.empty()) return out;
    for (const char* topic : {"plab/snapshots", "plab/journal", "plab/hashes"})
        if (std::find(topics.begin(), topics.end(), topic) == topics.end()) out += (out.empty() ? "" : ", ") + std::string(topic);
    return out;
}

Exit run_record(Context& c, RecordOptions o)
{
    if (auto topics = recorder::choose_topics(o.recorder.topics); !topics) return c.fail(Exit::Usage, topics.errors());
    if (const std::string missing = missing_for_replay(o.recorder.topics); !missing.empty())
        c.console.say("plabctl: the recording cannot be replayed: --topics is without " + missing);
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    const std::vector<link::ServerInfo> servers = c.session().servers(c.timeout(), 1);
    if (servers.empty()) return c.fail(Exit::NoServer, "server '" + c.session().server() + "' has gone");
    std::string& file = o.recorder.writer.file;
    if (file.empty()) file = name_with_time(c.session().server());
    o.recorder.writer.compression = *recording::parse_compression(o.compression);
    auto recorder = recorder::Recorder::open(c.session(), servers.front(), o.recorder);
    if (!recorder) return c.fail(Exit::Failed, recorder.errors());
    const recorder::State state = follow(c, **recorder, o);
    const auto closed = (*recorder)->close();
    if (state == recorder::State::Gone) c.console.say("plabctl: server '" + c.session().server() + "' has gone");
    if (state == recorder::State::Restarted)
        c.console.say("plabctl: server '" + c.session().server() + "' was restarted: a recording covers a single server process");
    // After Ctrl-C as well: the user wants to know the state of the file.
    const recorder::Progress progress = (*recorder)->progress();
    print_end(c, file, **recorder, progress);
    if (closed)
    {
        const Exit lost = report_losses(c, progress);
        return lost == Exit::Done && c.stopped() ? Exit::Interrupted : lost;
    }
    for (const Error& e : closed.errors()) c.console.say("plabctl: " + printable(e.text()));
    if (!progress.is_ended)
        c.console.say("plabctl: the file was not completed; recover its contents with: plabctl recover " + printable(file));
    return Exit::Failed;
}

}  // namespace

void add_record_command(const Command& app, Context& context)
{
    auto o = std::make_shared<RecordOptions>();
    const Command command =
        add_command(app, context, {"record", "record what a server publishes to a file, until the server ends or Ctrl-C", kRecordExamples},
                    [o](Context& c) { return run_record(c, *o); });
    command.add_option("-o,--output", o->recorder.writer.file, "default: SERVER_DATE_TIME.mcap").type_name("FILE.mcap");
    command.add_flag("--overwrite", o->recorder.writer.overwrite, "replace an existing file");
    command.add_option("--topics", o->recorder.topics, "record only these topics; default: all but plab/images and plab/contacts")
        .type_name("TOPIC ..");
    command.add_option("--until", o->recorder.until, "end at this simulated time").check(link::check_not_negative).type_name("SECONDS");
    command.add_option("--max-size", o->max_megabytes, "end when the file has so many MB (a little more is written)")
        .check(link::check_positive)
        .type_name("MB");
    command.add_option("--compression", o->compression, "none, lz4 or zstd").one_of({"none", "lz4", "zstd"}).show_default();
    command.add_option("--state-rate", o->recorder.state_rate, "maximum number of state frames per simulated second; default: all")
        .check(link::check_positive)
        .type_name("HZ");
}

}  // namespace plab::cli
