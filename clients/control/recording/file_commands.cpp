// info, export, recover: commands on a recording file, without a server.
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "control/recording/analysis/export.h"
#include "control/recording/analysis/gltf.h"
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
    std::string gltf, mjcf;
    std::optional<double> every;
    analysis::ExportOptions options;
};

/// Why these options do not go together; "" if they do.
std::string contradiction(const Context& c, const ExportArguments& o)
{
    if (int(o.csv) + int(c.settings.json) + int(!o.gltf.empty()) + int(!o.mjcf.empty()) != 1)
        return "export needs either --csv, --json, --gltf FILE or --mjcf FILE";
    if (!o.mjcf.empty() && (o.options.span.from || o.options.span.to || o.every || !o.options.topics.empty() || !o.options.out.empty()))
        return "--mjcf excludes the options for recordings";
    if (o.mjcf.empty() && o.file.empty()) return "export needs a recording";
    if (o.options.span.from && o.options.span.to && *o.options.span.to < *o.options.span.from) return "--to is before --from";
    if (o.gltf.empty()) return o.every ? "--every requires --gltf" : "";
    if (!o.options.topics.empty() || !o.options.out.empty()) return "--gltf has a file of its own, and no topics";
    return o.every && !(*o.every >= 0) ? "--every must not be negative" : "";
}

Exit run_export(Context& c, const ExportArguments& o)
{
    if (const std::string why = contradiction(c, o); !why.empty()) return c.fail(Exit::Usage, why);
    if (!o.mjcf.empty()) return c.export_mjcf(c, o.file, o.mjcf);
    const std::string& out = o.gltf.empty() ? o.options.out : o.gltf;
    const bool is_printed = out.empty() || out == "-";
    Work work(c, "export " + o.file, is_printed);
    auto log = Log::open(o.file, work.watch());
    if (!log && !c.stopped()) return c.fail(Exit::Failed, log.errors());
    auto done = !log              ? Result<analysis::Exported>(log.errors())
                : !o.gltf.empty() ? analysis::export_gltf(*log, {o.options.span, o.gltf, o.every.value_or(1.0 / 60)})
                : o.csv           ? analysis::export_csv(*log, o.options)
                                  : analysis::export_json(*log, o.options);
    if (c.stopped()) return work.interrupted(is_printed ? "the output is incomplete" : out + " is not written");
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
    const Command exported = add_command(
        app, context,
        {"export", "export a recording as tables (CSV), lines of JSON, or a film in three dimensions (glTF); or a scene as MJCF",
         "  plabctl export run.mcap --csv > states.csv                one row per object and frame\n"
         "  plabctl export run.mcap --csv --topic events --from 2 --to 3\n"
         "  plabctl export run.mcap --csv -o tables/                  one file per topic that has a table\n"
         "  plabctl export run.mcap --json -o run.jsonl               everything, one message per line\n"
         "  plabctl export run.mcap --gltf run.glb                    shapes and their motion, for viewers and Blender\n"
         "  plabctl export --mjcf scene.xml                           the server's scene as it is, for MuJoCo\n"
         "  plabctl export scenes/imported/gate.world --mjcf scene.xml\n"},
        [e](Context& c) { return run_export(c, *e); });
    exported.add_option("file", e->file, "recording (MCAP); of --mjcf a scene, or the server's without one").type_name("FILE");
    exported.add_flag("--csv", e->csv, "tables; the column names include the unit");
    exported.add_option("--gltf", e->gltf, "binary glTF 2.0 with an animation").type_name("FILE");
    exported.add_option("--mjcf", e->mjcf, "the scene as MJCF; what that cannot say is listed").type_name("FILE");
    exported.add_option("--every", e->every, "of --gltf: least time between key frames, s; default 1/60").type_name("SECONDS");
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
