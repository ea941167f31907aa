#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "control/console/json.h"
#include "control/live/commands.h"
#include "control/live/request.h"
#include "link/numbers.h"

namespace plab::cli
{
namespace
{

std::string rate_text(double factor) { return factor > 0 ? (factor == 1 ? "real" : number(factor)) : "max"; }

/// The server's state, for commands that only ask.
Result<link::ServerInfo> state_of_server(Context& c)
{
    auto catalogue = link::Catalogue::open(c.session(), 0);
    if (!catalogue) return catalogue.errors();
    if (auto fetched = catalogue->fetch(c.timeout(), c.stop()); !fetched) return fetched.errors();
    return *catalogue->now().server;
}

/// Prints what `text` and `json` make of the server's state.
Exit print_state(Context& c, const std::function<std::string(const link::ServerInfo&)>& text,
                 const std::function<Json(const link::ServerInfo&)>& json)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto state = state_of_server(c);
    if (!state) return c.fail(Exit::NoServer, state.errors());
    if (c.settings.json)
        print(c.console, json(*state));
    else
        c.console.out(text(*state) + "\n");
    return Exit::Done;
}

void add_plain(const Command& app, Context& context, const CommandText& text)
{
    auto timing = std::make_shared<Timing>();
    add_timing(add_command(app, context, text, [timing, verb = text.name](Context& c) { return send(c, {{verb}}, *timing); }), *timing);
}

void add_step(const Command& app, Context& context)
{
    auto count = std::make_shared<std::int64_t>(1);
    const Command command = add_command(app, context,
                                        {"step", "let a paused server execute a number of steps",
                                         "  plabctl pause && plabctl step\n  plabctl step 100 && plabctl wait --step 700\n"},
                                        [count](Context& c) {
                                            return send(c, {{"step", "", std::to_string(*count)}});
                                        });
    command.add_option("count", *count, "steps, default 1").check(link::check_count).type_name("N");
}

void add_rate(const Command& app, Context& context)
{
    auto rate = std::make_shared<std::string>();
    const auto text = [](const link::ServerInfo& s)
    {
        return "rate " + rate_text(s.rate_asked) + ", reached " + number(s.rate_reached) + (s.paused ? ", paused" : "") +
               (s.slipped > 0 ? ", " + number(s.slipped) + " s slipped" : "");
    };
    const auto json = [](const link::ServerInfo& s) -> Json
    {
        return {{"server", s.name},
                {"rate_asked", s.rate_asked},
                {"rate_reached", s.rate_reached},
                {"paused", s.paused},
                {"slipped", s.slipped}};
    };
    const Command command = add_command(app, context,
                                        {"rate", "set the pace, or print it",
                                         "  plabctl rate real\n  plabctl rate 0.1     slow motion\n"
                                         "  plabctl rate max\n  plabctl rate         print the current rate\n"},
                                        [rate, text, json](Context& c) {
                                            return rate->empty() ? print_state(c, text, json) : send(c, {{"rate", "", *rate}});
                                        });
    command.add_option("rate", *rate, "real, max, or a factor of real time").type_name("RATE");
}

void add_dt(const Command& app, Context& context)
{
    struct DtOptions
    {
        std::string dt;
        Timing timing;
    };
    auto o = std::make_shared<DtOptions>();
    const auto text = [](const link::ServerInfo& s) { return "dt " + exact_number(s.dt) + " s (1/" + number(1 / s.dt) + ")"; };
    const auto json = [](const link::ServerInfo& s) -> Json { return {{"server", s.name}, {"dt", s.dt}}; };
    const Command command = add_command(app, context, {"dt", "set the step length, or print it", "  plabctl dt 1/480\n  plabctl dt\n"},
                                        [o, text, json](Context& c) {
                                            return o->dt.empty() ? print_state(c, text, json) : send(c, {{"dt", "", o->dt}}, o->timing);
                                        });
    command.add_option("dt", o->dt, "seconds, as a number or a fraction").type_name("DT");
    add_timing(command, o->timing);
}

void add_load(const Command& app, Context& context)
{
    auto file = std::make_shared<std::string>();
    const Command command = add_command(app, context,
                                        {"load", "load another scene in place of this one; a new run begins",
                                         "  plabctl load scenes/fan_and_balloons.xml\n  cat scene.xml | plabctl load -\n"},
                                        [file](Context& c)
                                        {
                                            auto text = read_text(*file);
                                            if (!text) return c.fail(Exit::Failed, text.errors());
                                            const std::string name = *file == "-" ? "standard input" : *file;
                                            return send(c, {{"load", "", name, text.take()}});
                                        });
    command.add_option("file", *file, "blueprint; - is standard input").required().type_name("FILE");
}

void add_cancel(const Command& app, Context& context)
{
    auto name = std::make_shared<std::string>();
    const Command command = add_command(app, context,
                                        {"cancel", "cancel a request that is still waiting",
                                         "  plabctl cancel 3f9c01d2a4b5e6f70819a2b3c4d5e6f7:1\n"
                                         "plabctl prints the name of the request when it times out.\n"},
                                        [name](Context& c) {
                                            return send(c, {{"cancel", "", *name}});
                                        });
    command.add_option("request", *name, "name of the request, as printed at the time-out: client:number")
        .required()
        .type_name("CLIENT:NUMBER");
}

Exit run_shutdown(Context& c)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto catalogue = link::Catalogue::open(c.session(), 0);
    if (!catalogue) return c.fail(Exit::Failed, catalogue.errors());
    if (auto fetched = catalogue->fetch(c.timeout(), c.stop()); !fetched) return c.fail(Exit::NoServer, fetched.errors());
    if (const Exit e = send(c, {{"shutdown"}}); e != Exit::Done) return e;
    const auto end = link::moment_after(c.timeout());
    while (!catalogue->server_is_gone())
    {
        if (c.stopped()) return Exit::Interrupted;
        if (std::chrono::steady_clock::now() >= end)
            return c.fail(Exit::NoServer, "server '" + c.session().server() + "' accepted the shutdown, but is still running");
        (void)catalogue->wait(link::Seconds(0.1));
    }
    return Exit::Done;
}

}  // namespace

void add_clock_commands(const Command& app, Context& context)
{
    add_plain(app, context, {"pause", "stop the clock", "  plabctl pause\n  plabctl pause --at 1000\n"});
    add_plain(app, context, {"resume", "let the clock continue", "  plabctl resume\n"});
    add_step(app, context);
    add_rate(app, context);
    add_dt(app, context);
    add_plain(app, context, {"reset", "return to the scene as it was loaded; a new run begins", "  plabctl reset\n"});
    add_load(app, context);
    add_cancel(app, context);
    add_command(app, context, {"shutdown", "shut the server down, and wait until it has ended", "  plabctl shutdown --server lab\n"},
                run_shutdown);
}

}  // namespace plab::cli
