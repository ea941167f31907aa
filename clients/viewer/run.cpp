#include "viewer/run.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "program/progress.h"
#include "viewer/feed.h"
#include "viewer/file_source.h"
#include "viewer/frame_sink.h"
#include "viewer/live_source.h"
#include "viewer/painter.h"
#include "viewer/sequence.h"

namespace plab::view
{
namespace
{

constexpr std::size_t kBarWidth = 30;

Outcome failed(const Error& error) { return {Exit::Failed, error.text()}; }

std::string in_seconds(double value)
{
    char text[48];
    std::snprintf(text, sizeof text, "%.3f s", value);
    return text;
}

program::ProgressTo progress_to(const ViewerOptions& options)
{
    return options.progress ? program::ProgressTo::Lines : program::ProgressTo::Terminal;
}

void show(program::Progress& progress, const char* what, std::uint64_t done, std::optional<std::uint64_t> total, double time)
{
    if (!progress.is_due()) return;
    const std::string head =
        total ? program::bar(static_cast<double>(done) / static_cast<double>(std::max<std::uint64_t>(1, *total)), kBarWidth) + "  " : "";
    progress.show(head + std::to_string(done) + " " + what + ", t = " + in_seconds(time));
}

/// A line of its own.
void say(program::Progress& progress, const std::string& message)
{
    progress.clear();
    std::fprintf(stderr, "plab-view: %s\n", message.c_str());
}

/// One picture; prints its time, because the first state at or after a time may be later than that.
Result<void> take_shot(const Shot& shot, const Moment& moment, Painter& painter)
{
    auto picture = painter.paint(moment, shot.camera);
    if (!picture) return picture.errors();
    if (auto written = picture::write_png(shot.file, **picture); !written) return written;
    std::printf("%s: t = %s, step %lld\n", shot.file.c_str(), in_seconds(moment.state.time).c_str(),
                static_cast<long long>(moment.state.step));
    std::fflush(stdout);
    return {};
}

Outcome take_shots(const ViewerOptions& options, Feed& feed, Painter& painter)
{
    program::Progress progress(progress_to(options));
    std::optional<Moment> moment;
    std::uint64_t taken = 0;
    for (const Shot& shot : options.shots)
    {
        while (!moment || (shot.at && moment->state.time < *shot.at - kSameTime))
        {
            moment = feed.next();
            if (!moment) return {feed.end().exit, "'" + shot.file + "' cannot be made: " + feed.end().message};
            show(progress, "pictures", taken, options.shots.size(), moment->state.time);
        }
        if (auto done = take_shot(shot, *moment, painter); !done) return failed(done.error());
        ++taken;
    }
    return {};
}

/// Facts that the pictures do not show by themselves.
void report_doubts(const ViewerOptions& options, const Sequence& sequence, std::uint64_t given_up, program::Progress& progress)
{
    if (sequence.runs() > 1) say(progress, "the scene was loaded or reset meanwhile: times restart in the frames");
    if (given_up > 0)
        say(progress, std::to_string(given_up) + " states were skipped: drawing is slower than the simulation (try a lower --rate there)");
    if (sequence.widest_gap() > 1.5 / options.frames_per_simulated_second())
        say(progress, "some frames are drawn between states that are up to " + in_seconds(sequence.widest_gap()) + " apart");
}

/// What is missing at the end, as an outcome.
Outcome judge(const Sequence& sequence, const Feed& feed)
{
    const std::string lost = sequence.missing() > 0 ? "the first " + std::to_string(sequence.missing()) +
                                                          " frames cannot be made: they are of before the first state that came"
                                                    : "";
    if (sequence.done()) return lost.empty() ? Outcome{} : Outcome{Exit::Failed, lost};
    // Without an end time, the end of the server is the end.
    if (feed.server_has_gone() && !sequence.total() && sequence.drawn() > 0) return {};
    std::string why = feed.end().message;
    if (const auto total = sequence.total())
        why += "; " + std::to_string(*total - sequence.drawn()) + " of " + std::to_string(*total) + " frames cannot be made" +
               (sequence.drawn() > 0 ? ", the last state was of t = " + in_seconds(sequence.time()) : "");
    return {feed.end().exit, why};
}

/// What was drawn until then is kept, and reported as incomplete.
Outcome interrupted(const ViewerOptions& options, const Sequence& sequence)
{
    std::string message = "interrupted";
    if (const auto total = sequence.total(); total && sequence.drawn() > 0)
        message += ": " + options.target + " has " + std::to_string(sequence.drawn()) + " of " + std::to_string(*total) + " frames";
    return {Exit::Interrupted, message};
}

Outcome make_sequence(const ViewerOptions& options, Source& source, Feed& feed, const link::Stop& stop, Painter& painter, FrameSink& sink)
{
    program::Progress progress(progress_to(options));
    const auto begin = std::chrono::steady_clock::now();
    Sequence sequence({options.frames_per_simulated_second(), options.at, options.duration, options.until});
    const auto draw = [&](std::uint64_t index, const Moment& moment) -> Result<void>
    {
        if (stop()) return reason("interrupted");
        auto picture = painter.paint(moment);
        if (!picture) return picture.errors();
        auto added = sink.add(index, **picture);
        show(progress, "frames", sequence.drawn() + 1, sequence.total(), moment.state.time);
        return added;
    };
    while (!sequence.done())
    {
        auto moment = feed.next();
        if (!moment) break;
        const auto drawn = sequence.advance(std::move(*moment), draw);
        if (stop()) break;
        if (!drawn) return failed(drawn.error());
    }
    const Outcome outcome = stop() ? interrupted(options, sequence) : judge(sequence, feed);
    if (sequence.drawn() > 0)
        if (auto finished = sink.finish(); !finished) return failed(finished.error());
    report_doubts(options, sequence, source.given_up(), progress);
    progress.clear();
    std::fprintf(stderr, "%llu frames, %.1f s\n", static_cast<unsigned long long>(sequence.drawn()),
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    return outcome;
}

Outcome draw(const ViewerOptions& options, Source& source, const link::Stop& stop, Painter& painter)
{
    Feed feed(source, options, stop);
    if (options.task == Task::Shots) return take_shots(options, feed, painter);
    auto sink = open_frame_sink(options);
    if (!sink) return failed(sink.error());
    return make_sequence(options, source, feed, stop, painter, **sink);
}

/// Nothing before it is drawn.
std::optional<double> first_time(const ViewerOptions& options)
{
    return options.task == Task::Shots ? options.shots.front().at : options.at;
}

}  // namespace

Outcome run(const ViewerOptions& options, const link::Stop& stop)
{
    // Everything that can fail without a server is done before waiting for one.
    if (options.task == Task::Film)
        if (auto ffmpeg = find_ffmpeg(); !ffmpeg) return failed(ffmpeg.error());
    auto painter = Painter::make(options);
    if (!painter) return failed(painter.error());

    const auto unreached = [&](const Error& error) -> Outcome {
        return stop() ? Outcome{Exit::Interrupted, "interrupted"} : Outcome{Exit::NoServer, error.text()};
    };
    if (!options.recording.empty())
    {
        auto source = FileSource::open(options.recording, first_time(options));
        return source ? draw(options, **source, stop, *painter) : failed(source.error());
    }
    auto session = link::Session::join(options.link);
    if (!session) return failed(session.error());
    if (auto found = session->find_server(options.link, options.timeout, stop); !found) return unreached(found.error());
    const Grid grid{options.task == Task::Shots ? 0 : options.frames_per_simulated_second(), options.at};
    auto source = LiveSource::open(*session, grid, options.timeout, stop);
    return source ? draw(options, **source, stop, *painter) : unreached(source.error());
}

}  // namespace plab::view
