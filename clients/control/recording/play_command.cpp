#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "control/console/json.h"
#include "control/recording/commands.h"
#include "control/recording/player/control.h"
#include "control/recording/player/player.h"
#include "control/recording/player/terminal.h"
#include "link/numbers.h"
#include "program/progress.h"

namespace plab::cli
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr const char* kPlayExamples =
    "  plabctl play run.mcap                          as it was, under the recorded server's name\n"
    "  plabctl play run.mcap --name again --rate 0.2  in slow motion, beside the server itself\n"
    "  plabctl play run.mcap --from 3 --to 5 --loop   repeat these two seconds\n"
    "  plabctl play run.mcap --from 3 --pause         paused at 3 s\n"
    "  plabctl play run.mcap --readers 1 & plabctl record -o again.mcap\n"
    "On a terminal: space pauses, left and right jump back and forward by a second, up and down double and halve the rate,\n"
    "q quits. Clients see the playback as a server; it refuses requests.\n";

constexpr std::chrono::milliseconds kPlaySlice(40);  // how late a key or Ctrl-C may be seen
constexpr std::uint64_t kSecond = 1'000'000'000;

std::string check_rate(const std::string& text)
{
    const bool is_rate = link::check_positive(text).empty();
    const double rate = is_rate ? std::stod(text) : 0;
    return rate >= player::Pace::kSlowest && rate <= player::Pace::kFastest ? "" : "must be from 0.001 to 1000, not '" + text + "'";
}

double in_seconds(std::uint64_t time) { return static_cast<double>(time) * 1e-9; }

/// False: the playback should end.
bool handle_key(player::Player& player, player::Key key)
{
    const Clock::time_point now = Clock::now();
    const player::Pace& pace = player.pace();
    const std::uint64_t at = pace.position(now);
    switch (key)
    {
        case player::Key::Pause:
            player.pause(!pace.is_paused(), now);
            break;
        case player::Key::Back:
            player.seek(at > kSecond ? at - kSecond : 0, now);
            break;
        case player::Key::Forward:
            player.seek(at + kSecond, now);
            break;
        case player::Key::Faster:
            player.set_rate(pace.rate() * 2, now);
            break;
        case player::Key::Slower:
            player.set_rate(pace.rate() / 2, now);
            break;
        case player::Key::Quit:
            return false;
    }
    return true;
}

void show(program::Progress& line, const player::Player& player)
{
    if (!line.is_due()) return;
    const player::Pace& pace = player.pace();
    const player::PlaybackState state = player.state();
    line.show(player::bar({in_seconds(pace.span().from), in_seconds(pace.span().to), in_seconds(pace.position(Clock::now())), pace.rate(),
                           pace.is_paused(), state.time, state.run},
                          line.width() - 1));
}

/// Who controls a playback: a person at the terminal, or another program.
class Controls
{
public:
    virtual ~Controls() = default;
    /// Does what was asked; false: the playback should end.
    virtual bool update(const Context& c, player::Player& player, Clock::time_point now) = 0;
};

class TerminalControls final : public Controls
{
public:
    explicit TerminalControls(const Context& c) : line_(c.progress_to(), std::chrono::milliseconds(0)) {}
    bool update(const Context&, player::Player& player, Clock::time_point) override
    {
        bool goes_on = true;
        for (const player::Key key : keys_.take(terminal_.read())) goes_on = handle_key(player, key) && goes_on;
        show(line_, player);
        return goes_on;
    }

private:
    player::Terminal terminal_;
    program::Progress line_;
    player::KeyParser keys_;
};

/// Commands from standard input, and the position to standard output. At its end the playback waits for a seek.
class ProgramControls final : public Controls
{
public:
    bool update(const Context& c, player::Player& player, Clock::time_point now) override
    {
        bool goes_on = true;
        for (const auto& command : lines_.take(input_.read()))
        {
            if (!command)
                c.console.say("plabctl: " + printable(command.error().text()));
            else
                goes_on = handle(*command, player, now) && goes_on;
        }
        const player::Pace& pace = player.pace();
        if (!pace.is_paused() && player.has_begun() && pace.at_end(now)) player.pause(true, now);
        report(c, player, now);
        return goes_on && !input_.is_closed();
    }

private:
    static bool handle(const player::ControlCommand& command, player::Player& player, Clock::time_point now)
    {
        using Kind = player::ControlCommand::Kind;
        const player::Pace& pace = player.pace();
        if (command.kind == Kind::Resume && pace.at_end(now)) player.seek(pace.span().from, now);
        if (command.kind == Kind::Pause || command.kind == Kind::Resume) player.pause(command.kind == Kind::Pause, now);
        if (command.kind == Kind::Rate) player.set_rate(command.value, now);
        if (command.kind == Kind::Seek) player.seek(static_cast<std::uint64_t>(command.value * 1e9), now);
        return command.kind != Kind::End;
    }
    void report(const Context& c, const player::Player& player, Clock::time_point now)
    {
        constexpr std::chrono::milliseconds kBetween(100);
        const player::Pace& pace = player.pace();
        const Json state{{"server", player.name()},
                         {"from", in_seconds(pace.span().from)},
                         {"to", in_seconds(pace.span().to)},
                         {"at", in_seconds(player.has_begun() ? pace.position(now) : pace.span().from)},
                         {"rate", pace.rate()},
                         {"paused", pace.is_paused()}};
        if (now - reported_at_ < kBetween || state == reported_) return;
        print(c.console, state);
        (void)c.console.flush();
        reported_ = state, reported_at_ = now;
    }

    player::ControlInput input_;
    player::ControlLines lines_;
    Json reported_;
    Clock::time_point reported_at_{};
};

/// Until it is over, the user ends it, or another server has its name.
Result<void> follow(const Context& c, player::Player& player, Controls& controls)
{
    const Clock::time_point begin = Clock::now();
    bool goes_on = true;
    while (goes_on && !player.is_over() && !c.stopped())
    {
        const Clock::time_point now = Clock::now();
        goes_on = controls.update(c, player, now);
        if (auto stepped = player.step(now); !stepped) return stepped;
        if (c.settings.duration && link::Seconds(now - begin).count() >= *c.settings.duration) goes_on = false;
        if (c.settings.count && player.sent() >= *c.settings.count) goes_on = false;
        if (goes_on && !player.is_over()) player.wait(now + kPlaySlice);
    }
    return {};
}

void print_end(const Context& c, const std::string& file, const player::Player& player)
{
    const double at = in_seconds(player.pace().position(Clock::now()));
    if (c.settings.json)
        print(c.console, {{"file", file},
                          {"server", player.name()},
                          {"position", at},
                          {"run", player.state().run},
                          {"step", player.state().step},
                          {"time", player.state().time},
                          {"messages", player.sent()},
                          {"broken", player.broken()},
                          {"not_played", player.foreign()}});
    else
        c.console.out(printable(file) + ": played as '" + player.name() + "' to " + number(at) + " s, " + std::to_string(player.sent()) +
                      " messages\n");
    if (player.broken() > 0)
        c.console.say("plabctl: " + std::to_string(player.broken()) + " damaged messages were skipped: plabctl recover FILE");
}

struct PlayOptions
{
    player::PlaybackOptions playback;
    bool is_controlled = false;  ///< by another program
};

Result<void> play(const Context& c, player::Player& player, bool is_controlled)
{
    if (is_controlled)
    {
        ProgramControls controls;
        return follow(c, player, controls);
    }
    TerminalControls controls(c);
    return follow(c, player, controls);
}

Exit run_play(Context& c, const PlayOptions& o)
{
    player::PlaybackOptions options = o.playback;
    options.from_first_state = o.is_controlled;
    if (!options.name.empty() && !wire::is_server_name(options.name))
        return c.fail(Exit::Usage, "'" + options.name + "' is not a valid server name: use 1 to 64 letters, digits, '.', '_' or '-'");
    if (options.from && options.to && *options.to < *options.from) return c.fail(Exit::Usage, "--to is before --from");
    options.domain = c.settings.link.domain, options.version = PLAB_VERSION;
    auto player = player::Player::open(options);
    if (!player) return c.fail(Exit::Failed, player.errors());
    for (const std::string& topic : (*player)->foreign())
        c.console.say("plabctl: " + printable(topic) + " is not a topic of this version of pLab, and is not played");
    const auto followed = play(c, **player, o.is_controlled);
    if (!followed) return c.fail(Exit::Failed, followed.errors());
    if (c.stopped()) return Exit::Interrupted;
    if (!o.is_controlled) print_end(c, options.file, **player);
    return Exit::Done;
}

}  // namespace

void add_play_command(const Command& app, Context& context)
{
    auto all = std::make_shared<PlayOptions>();
    player::PlaybackOptions* const o = &all->playback;
    const Command command = add_command(app, context, {"play", "publish a recording on the bus, as its server did", kPlayExamples},
                                        [all](Context& c) { return run_play(c, *all); });
    command.add_option("file", o->file, "a recording").required().type_name("FILE");
    command.add_option("--rate", o->rate, "recorded seconds per second of real time; default: 1").check(check_rate).type_name("R");
    command.add_option("--from", o->from, "start at this time of the recording").check(link::check_not_negative).type_name("SECONDS");
    command.add_option("--to", o->to, "end there").check(link::check_not_negative).type_name("SECONDS");
    command.add_flag("--loop", o->loop, "start over at the end, as a new run");
    command.add_flag("--pause", o->paused, "start paused");
    command.add_option("--name", o->name, "server name to play under; default: the recorded server's").type_name("NAME");
    command.add_flag("--control", all->is_controlled,
                     "obey lines on standard input (pause, resume, rate R, seek SECONDS, end) and print the position; it waits at the end");
    command.add_option("--readers", o->readers, "start when this many readers of the states are connected")
        .check(link::check_whole)
        .type_name("N");
}

}  // namespace plab::cli
