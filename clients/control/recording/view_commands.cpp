// plot, report, log: views of recordings for people.
#include <memory>

#include "control/recording/analysis/curves.h"
#include "control/recording/analysis/lines.h"
#include "control/recording/analysis/report.h"
#include "control/recording/commands.h"
#include "control/recording/work.h"
#include "figures/chart.h"
#include "link/numbers.h"
#include "logger/logger.h"
#include "program/text_out.h"

namespace plab::cli
{
namespace
{

using analysis::Log;

// ---- plot -----------------------------------------------------------------------------------------------------------

struct PlotArguments
{
    std::string file, out;
    std::vector<std::string> quantities;
    analysis::Span span;
    bool has_events = true, has_log_scale = false;
};

Result<figures::Chart> chart_of(const Log& log, const PlotArguments& o)
{
    std::vector<analysis::Signal> quantities;
    for (const std::string& text : o.quantities)
    {
        auto parsed = analysis::parse_signal(text, log.things());
        if (!parsed) return parsed.errors();
        quantities.insert(quantities.end(), parsed->begin(), parsed->end());
    }
    figures::Chart chart;
    chart.curves = analysis::curves_of(log, quantities, o.span);
    for (const figures::Curve& curve : chart.curves)
        if (curve.points.empty()) return reason(log.path() + " has no value of '" + curve.name + "' in this time");
    chart.title = o.quantities.size() == 1 ? o.quantities.front() : std::to_string(o.quantities.size()) + " quantities";
    chart.subtitle = log.path();
    chart.kind = o.has_log_scale ? figures::Scale::Kind::Log : figures::Scale::Kind::Linear;
    chart.moments = analysis::moments_of(log, o.span, o.has_events);
    return chart;
}

Exit run_plot(Context& c, const PlotArguments& o)
{
    if (!o.out.ends_with(".svg") && !o.out.ends_with(".png"))
        return c.fail(Exit::Usage, "-o " + o.out + ": the name of a picture must end with .svg or .png");
    if (o.span.from && o.span.to && *o.span.to < *o.span.from) return c.fail(Exit::Usage, "--to is before --from");
    Work work(c, "plot " + o.file);
    auto log = Log::open(o.file, work.watch());
    if (!log && !c.stopped()) return c.fail(Exit::Failed, log.errors());
    auto chart = log ? chart_of(*log, o) : Result<figures::Chart>(log.errors());
    if (c.stopped()) return work.interrupted(o.out + " is not written");
    work.end();
    if (!chart) return c.fail(Exit::Failed, chart.errors());
    if (auto written = figures::write_picture(draw(*chart), o.out); !written) return c.fail(Exit::Failed, written.errors());
    return warn(c, log->troubles());
}

// ---- report ---------------------------------------------------------------------------------------------------------

struct ReportArguments
{
    std::string file, out;
};

Exit run_report(Context& c, const ReportArguments& o)
{
    Work work(c, "report " + o.file);
    auto log = Log::open(o.file, work.watch());
    if (!log && !c.stopped()) return c.fail(Exit::Failed, log.errors());
    auto summary = log ? analysis::summary_of(*log) : Result<analysis::Summary>(log.errors());
    if (!summary && !c.stopped()) return c.fail(Exit::Failed, summary.errors());
    const std::string page = c.stopped() ? "" : analysis::report_html(*log, *summary);
    if (c.stopped()) return work.interrupted(o.out + " is not written");
    work.end();
    if (auto written = program::write_file(o.out, page); !written) return c.fail(Exit::Failed, written.errors());
    return Exit::Done;
}

// ---- log ------------------------------------------------------------------------------------------------------------

struct LogArguments
{
    std::string file, severity = "info";
    analysis::LineOptions lines;
};

Exit log_live(const Context& c, const LogArguments& o)
{
    if (o.lines.span.from || o.lines.span.to) return c.fail(Exit::Usage, "--from and --to apply to recordings only: give a file");
    logger::LoggerOptions options;
    options.link = c.settings.link, options.filter = o.lines.filter, options.json = c.settings.json;
    options.count = c.settings.count, options.duration = c.settings.duration;
    options.timeout = c.timeout().count();
    const logger::End end = logger::follow(options, c.stop());
    if (c.stopped()) return Exit::Interrupted;
    return end.code == 0 ? Exit::Done : c.fail(static_cast<Exit>(end.code), end.errors);
}

Exit run_log(const Context& c, LogArguments o)
{
    logger::Filter& filter = o.lines.filter;
    // Either option alone selects only these; both or none select all.
    if (!filter.events && !filter.collisions) filter.events = filter.collisions = true;
    filter.severity = logger::severity_of(o.severity);
    if (o.file.empty()) return log_live(c, o);
    if (o.lines.span.from && o.lines.span.to && *o.lines.span.to < *o.lines.span.from) return c.fail(Exit::Usage, "--to is before --from");
    Work work(c, "log " + o.file, true);
    auto log = Log::open(o.file, work.watch());
    if (c.stopped()) return work.interrupted("nothing was printed");
    if (!log) return c.fail(Exit::Failed, log.errors());
    if (auto known = analysis::check_names(*log, filter); !known) return c.fail(Exit::Failed, known.errors());
    o.lines.json = c.settings.json, o.lines.count = c.settings.count;
    auto out = program::TextOut::open("");
    if (!out) return c.fail(Exit::Failed, out.errors());
    work.end();
    auto written = analysis::write_lines(*log, o.lines, *out);
    if (c.stopped()) return work.interrupted("the output is incomplete");
    work.end();
    return written ? warn(c, *written) : c.fail(Exit::Failed, written.errors());
}

void add_plot(const Command& app, Context& context)
{
    auto o = std::make_shared<PlotArguments>();
    const Command command =
        add_command(app, context,
                    {"plot", "plot quantities of a recording over time, with its swaps and events",
                     "  plabctl plot run.mcap --quantity red.position.z -o height.svg\n"
                     "  plabctl plot run.mcap --quantity red.speed --quantity fan.speed --from 1 --to 2 -o speeds.png\n"
                     "  plabctl plot run.mcap --quantity contact.response.cost --quantity energy.kinetic -o cost.svg\n"
                     "Bodies: position, orientation, linear_velocity, angular_velocity (.x .y .z .norm), speed. Shafts: angle, speed.\n"
                     "Interactions: cost, error, work, and their outputs. The scene: energy.kinetic, .stored, .total, .work,\n"
                     ".unexplained, momentum, angular_momentum, real_time_factor, step_cost, contacts, deepest, residual.\n"},
                    [o](Context& c) { return run_plot(c, *o); });
    add_file(command, o->file);
    command.add_option("-q,--quantity", o->quantities, "ID.QUANTITY (may be repeated); one panel per unit")
        .required()
        .repeated()
        .type_name("NAME");
    command.add_option("-o,--output", o->out, "picture: .svg or .png").required().type_name("FILE");
    command.add_flag("--no-events{false}", o->has_events, "mark warnings and failures only, not every event");
    command.add_flag("--log", o->has_log_scale, "logarithmic value axis; values that are not positive are left out");
    add_span(command, o->span);
}

void add_report(const Command& app, Context& context)
{
    auto o = std::make_shared<ReportArguments>();
    const Command command = add_command(app, context,
                                        {"report", "write a recording as one HTML page: energy, momentum, cost and error, swaps, events",
                                         "  plabctl report run.mcap -o report.html\n"},
                                        [o](Context& c) { return run_report(c, *o); });
    add_file(command, o->file);
    command.add_option("-o,--output", o->out, "page to write; '-' for standard output").required().type_name("FILE");
}

void add_log(const Command& app, Context& context)
{
    auto o = std::make_shared<LogArguments>();
    o->lines.filter.events = o->lines.filter.collisions = false;  // flags
    const Command command =
        add_command(app, context,
                    {"log", "print events and collisions as lines, from a recording or live",
                     "  plabctl log run.mcap --severity warning\n  plabctl log run.mcap --collisions --object red --from 2 --to 3\n"
                     "  plabctl log run.mcap --json | jq 'select(.kind == \"script.print\")'\n"
                     "  plabctl log                               follow a server live, until Ctrl-C (like plab-log)\n"},
                    [o](Context& c) { return run_log(c, *o); });
    command.add_option("file", o->file, "recording (MCAP); without it, follow a server").type_name("FILE");
    command.add_flag("--events", o->lines.filter.events, "events only");
    command.add_flag("--collisions", o->lines.filter.collisions, "collisions only");
    command.add_option("--kind", o->lines.filter.kinds, "only kinds with this prefix (may be repeated): collision.impact, script.")
        .repeated()
        .type_name("KIND");
    command.add_option("--object", o->lines.filter.objects, "only entries that refer to this component (may be repeated)")
        .repeated()
        .type_name("ID");
    command.add_option("--severity", o->severity, "minimum severity; collisions are info")
        .one_of({"info", "warning", "failure"})
        .type_name("WORD");
    add_span(command, o->lines.span);
}

}  // namespace

void add_view_commands(const Command& app, Context& context)
{
    add_plot(app, context);
    add_report(app, context);
    add_log(app, context);
}

}  // namespace plab::cli
