// info, export, recover: commands on a recording file, without a server.
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "control/recording/analysis/export.h"
#include "control/recording/analysis/summary.h"
#include "control/recording/commands.h"
#include "control/recording/summary_text.h"
#include "control/recording/work.h"
#include "idl/recording/recovery.h"
#include "link/numbers.h"

namespace plab::cli
{
namespace
{

using analysis::Log;

// ---- info -----------------------------------------------------------------------------------------------------------

Exit run_info(Context& c, const std::string& file)
{
    Work work(c, "info " + file);
    auto log = Log::open(file, work.watch());
    if (!log && !c.stopped()) return c.fail(Exit::Failed, log.errors());
    auto summary = log ? analysis::summary_of(*log) : Result<analysis::Summary>(log.errors());
    if (c.stopped()) return work.interrupted("nothing is known about the rest");
    if (!summary) return c.fail(Exit::Failed, summary.errors());
    work.end();
    if (c.settings.json)
        print(c.console, summary_json(*summary));
    else
        print_summary(c.console, *summary);
    return Exit::Done;
}

// ---- export ---------------------------------------------------------------------------------------------------------

struct ExportArguments
{
    std::string file;
    bool csv = false;
    analysis::ExportOptions options;
};

Exit run_export(Context& c, const ExportArguments& o)
{
    if (o.csv == c.settings.json) return c.fail(Exit::Usage, "export needs either --csv or --json");
    if (o.options.span.from && o.options.span.to && *o.options.span.to < *o.options.span.from)
        return c.fail(Exit::Usage, "--to is before --from");
    const bool is_printed = o.options.out.empty() || o.options.out == "-";
    Work work(c, "export " + o.file, is_printed);
    auto log = Log::open(o.file, work.watch());
    if (!log && !c.stopped()) return c.fail(Exit::Failed, log.errors());
    auto done = !log    ? Result<analysis::Exported>(log.errors())
                : o.csv ? analysis::export_csv(*log, o.options)
                        : analysis::export_json(*log, o.options);
    if (c.stopped()) return work.interrupted(is_printed ? "the output is incomplete" : o.options.out + " is not written");
    if (!done) return c.fail(Exit::Failed, done.errors());
    work.end();
    return warn(c, done->troubles);
}

// ---- recover --------------------------------------------------------------------------------------------------------

struct RecoverArguments
{
    std::string file, out;
};

/// "run.mcap" is recovered to "run.recovered.mcap".
std::string recovered_name(const std::string& file)
{
    const std::filesystem::path path(file);
    return (path.parent_path() / (path.stem().string() + ".recovered" + path.extension().string())).string();
}

Exit run_recover(Context& c, const RecoverArguments& o)
{
    const std::string out = o.out.empty() ? recovered_name(o.file) : o.out;
    Work work(c, "recover " + o.file);
    auto report = recording::recover(o.file, out, recording::Overwrite::No, {}, work.watch());
    if (c.stopped() && !report) return work.interrupted(out + " is not written");
    work.end();
    if (!report) return c.fail(Exit::Failed, report.errors());
    if (c.settings.json)
        print(c.console, recovery_json(*report, out));
    else
        print_recovery(c.console, *report, out);
    return static_cast<Exit>(recording::exit_code(report->verdict));
}

}  // namespace

void add_file_commands(const Command& app, Context& context)
{
    auto info = std::make_shared<std::string>();
    add_file(add_command(app, context,
                         {"info", "summarize a recording: runs, topics, swaps, events, gaps, snapshots",
                          "  plabctl info run.mcap\n  plabctl info run.mcap --json | jq '.topics[] | [.topic, .messages]'\n"},
                         [info](Context& c) { return run_info(c, *info); }),
             *info);

    auto e = std::make_shared<ExportArguments>();
    const Command exported =
        add_command(app, context,
                    {"export", "export a recording as tables (CSV) or lines of JSON",
                     "  plabctl export run.mcap --csv > states.csv                one row per object and frame\n"
                     "  plabctl export run.mcap --csv --topic events --from 2 --to 3\n"
                     "  plabctl export run.mcap --csv -o tables/                  one file per topic that has a table\n"
                     "  plabctl export run.mcap --json -o run.jsonl               everything, one message per line\n"},
                    [e](Context& c) { return run_export(c, *e); });
    add_file(exported, e->file);
    exported.add_flag("--csv", e->csv, "tables; the column names include the unit");
    exported.add_option("--topic", e->options.topics, "this topic (may be repeated): states, events, ..").repeated().type_name("TOPIC");
    exported.add_option("-o,--output", e->options.out, "file, or for tables a folder (an existing one, or a path that ends with '/')")
        .type_name("PATH");
    add_span(exported, e->options.span);

    auto r = std::make_shared<RecoverArguments>();
    const Command recover = add_command(app, context,
                                        {"recover", "save the intact part of a truncated or damaged recording",
                                         "  plabctl recover run.mcap                  to run.recovered.mcap\n"
                                         "  plabctl recover run.mcap -o good.mcap || echo \"exit code $?\"\n"
                                         "Exit codes: 0 complete, 5 something is lost, 1 nothing is usable.\n"},
                                        [r](Context& c) { return run_recover(c, *r); });
    add_file(recover, r->file);
    recover.add_option("-o,--output", r->out, "new file; must not exist yet").type_name("FILE");
}

}  // namespace plab::cli
