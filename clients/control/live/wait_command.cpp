#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "control/console/json.h"
#include "control/live/commands.h"
#include "control/live/frames.h"
#include "link/caller.h"
#include "link/catalogue.h"
#include "link/frame_reader.h"
#include "link/numbers.h"

namespace plab::cli
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr double kWait = 30;  // s

struct WaitOptions
{
    std::optional<std::int64_t> step;
    std::optional<double> time;

    bool reached(std::int64_t at_step, double at_time) const { return (!step || at_step >= *step) && (!time || at_time >= *time); }
};

struct RunMoment
{
    std::uint64_t run = 0;
    std::int64_t step = 0;
    double time = 0;
};

/// The server's state gives the time once per second and at every change, frames in between.
std::optional<RunMoment> wait_for_place(Context& c, link::Catalogue& catalogue, const WaitOptions& o, RunMoment place,
                                        Clock::time_point end)
{
    auto frames = link::FrameReader::open(c.session());
    while (!c.stopped() && Clock::now() < end && !catalogue.server_is_gone())
    {
        if (frames) (void)frames->take([&](const plab_v2_Frame& f) { place = {f.run, f.step, f.time}; });
        (void)catalogue.update();
        if (const auto& s = catalogue.now().server; s && (s->run > place.run || (s->run == place.run && s->step > place.step)))
            place = {s->run, s->step, s->time};
        if (o.reached(place.step, place.time)) return place;
        if (frames)
            (void)c.session().wait(*frames, std::min(link::Seconds(0.05), link::Seconds(end - Clock::now())));
        else
            (void)catalogue.wait(link::Seconds(0.05));
    }
    return {};
}

Exit run_wait(Context& c, const WaitOptions& o)
{
    const auto start = Clock::now();
    const auto end = link::moment_after(c.timeout(kWait), start);
    const auto left = [&] { return std::max(link::Seconds(0), link::Seconds(end - Clock::now())); };
    if (const Exit e = c.connect(kWait); e != Exit::Done) return e;
    // Ready means: the server answers requests, and its complete catalogue is known.
    auto caller = link::Caller::make(c.session(), left(), c.stop());
    if (!caller) return c.fail(Exit::NoServer, caller.errors());
    auto catalogue = link::Catalogue::open(c.session());
    if (!catalogue) return c.fail(Exit::Failed, catalogue.errors());
    if (auto fetched = catalogue->fetch(left(), c.stop()); !fetched) return c.fail(Exit::NoServer, fetched.errors());
    RunMoment place{catalogue->now().server->run, catalogue->now().server->step, catalogue->now().server->time};
    if (o.step || o.time)
    {
        const auto reached = wait_for_place(c, *catalogue, o, place, end);
        if (!reached && catalogue->server_is_gone()) return c.fail(Exit::NoServer, "server '" + c.session().server() + "' has gone");
        if (!reached)
            return c.fail(Exit::NoServer, "server '" + c.session().server() + "' did not reach it within the time-out" +
                                              (catalogue->now().server && catalogue->now().server->paused ? ": it is paused" : ""));
        place = *reached;
    }
    const double waited = link::Seconds(Clock::now() - start).count();
    if (c.settings.json)
        print(c.console,
              {{"server", c.session().server()}, {"run", place.run}, {"step", place.step}, {"time", place.time}, {"waited_s", waited}});
    else
        c.console.out("server '" + c.session().server() + "' is " + (o.step || o.time ? "at" : "ready at") + " step " +
                      std::to_string(place.step) + " (" + number(place.time) + " s)\n");
    return Exit::Done;
}

}  // namespace

void add_wait_command(const Command& app, Context& context)
{
    auto o = std::make_shared<WaitOptions>();
    const Command command = add_command(app, context,
                                        {"wait", "wait until the server is ready, or has reached a step or time",
                                         "  plabd scene.xml --name lab & plabctl wait --server lab\n"
                                         "  plabctl wait --step 1200\n  plabctl wait --time 5 --timeout 60\n"},
                                        [o](Context& c) { return run_wait(c, *o); });
    command.add_option("--step", o->step, "until this step is done; default time-out: 30 s").check(link::check_whole).type_name("N");
    command.add_option("--time", o->time, "until this simulated time").check(link::check_not_negative).type_name("SECONDS");
}

}  // namespace plab::cli
