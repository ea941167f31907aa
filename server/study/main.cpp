// plab-study: error against run time, offline. Puts together command line, plugins, scene, study and files.
#include <cstdio>
#include <optional>

#include "blueprint/reader.h"
#include "exact/closed_form.h"
#include "model/compile.h"
#include "plugins/library.h"
#include "program/interruption.h"
#include "program/progress.h"
#include "study/allocations.h"
#include "study/govern.h"
#include "study/options.h"
#include "study/suite.h"
#include "study/verify.h"
#include "study/write.h"

namespace
{

using namespace plab;

/// A signal abandons the current run, even in the middle of a step.
Interruption work;

int fail(const Errors& errors, int code = 1)
{
    for (const Error& e : errors) std::fprintf(stderr, "plab-study: %s\n", e.text().c_str());
    return program::is_interrupted() ? program::code_of_interruption() : code;
}

program::ProgressTo progress_to(const study::StudyOptions& options)
{
    return options.quiet ? program::ProgressTo::Nowhere : options.progress ? program::ProgressTo::Lines : program::ProgressTo::Terminal;
}

/// Progress messages of a study.
std::function<void(const std::string&)> shown_by(program::Progress& line)
{
    return [&line](const std::string& text)
    {
        if (line.is_due()) line.show(text + "  (Ctrl-C ends)");
    };
}

std::string duration_text(double seconds)
{
    char text[48];
    if (seconds < 100)
        std::snprintf(text, sizeof text, "%.2g s", std::max(seconds, 0.1));
    else if (seconds < 6000)
        std::snprintf(text, sizeof text, "%.0f min", seconds / 60);
    else
        std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
    return text;
}

int list_exact()
{
    for (const exact::Entry& e : exact::closed_forms())
        std::printf("exact:%-14.*s %.*s\n%-20s needs: %.*s\n", static_cast<int>(e.name.size()), e.name.data(),
                    static_cast<int>(e.what.size()), e.what.data(), "", static_cast<int>(e.needs.size()), e.needs.data());
    return 0;
}

int list(const study::Plan& plan, model::TypeSource& types)
{
    int refused = 0;
    for (const study::Combination& c : plan.combinations)
    {
        const auto scene = study::apply(plan.scene, types, c.settings);
        std::printf("%s%s\n", c.label().c_str(), scene ? "" : ("   refused: " + scene.error().text()).c_str());
        refused += scene ? 0 : 1;
    }
    std::printf("%zu combinations, %d refused\n", plan.combinations.size(), refused);
    return 0;
}

/// "22 studies, 583 combinations, each run 1 + 3 times: about 2 h of CPU time, by the first steps of each"
std::string workload_text(const std::vector<study::SuiteLine>& lines, int repeat)
{
    study::Workload all;
    for (const study::SuiteLine& line : lines) all.cells += line.work.cells, all.seconds += line.work.seconds;
    return std::to_string(lines.size()) + (lines.size() == 1 ? " study, " : " studies, ") + std::to_string(all.cells) +
           " combinations, each run 1 + " + std::to_string(repeat) + " times: about " + duration_text(all.seconds) +
           " of CPU time, by the first steps of each";
}

int list_suite(const std::vector<study::SuiteLine>& lines, int repeat)
{
    std::size_t width = 5;
    for (const study::SuiteLine& line : lines) width = std::max(width, line.entry->name.size());
    std::printf("%-*s  %12s  %10s  %s\n", static_cast<int>(width), "study", "combinations", "about", "title");
    for (const study::SuiteLine& line : lines)
        std::printf("%-*s  %12zu  %10s  %s%s\n", static_cast<int>(width), line.entry->name.c_str(), line.work.cells,
                    line.trouble.empty() ? duration_text(line.work.seconds).c_str() : "-", line.entry->title.c_str(),
                    line.trouble.empty() ? "" : ("; cannot be studied: " + line.trouble).c_str());
    std::printf("%s\n", workload_text(lines, repeat).c_str());
    return 0;
}

study::Plan plan_of(const study::StudyOptions& options, model::SceneSpec scene)
{
    study::Plan plan;
    plan.scene = std::move(scene), plan.command = options.command, plan.combinations = study::combine(options.algorithms, options.varied);
    plan.reference = options.reference, plan.repeat = options.repeat, plan.scales = options.scales;
    plan.run.until = options.until, plan.run.quantities = options.quantities, plan.swaps = options.swaps;
    plan.run.floor = options.floor, plan.run.budget = options.budget, plan.run.allocations = &study::allocations;
    plan.run.stop = &work;
    return plan;
}

void print_findings(const std::vector<std::string>& sentences, const std::string& folder)
{
    for (const std::string& s : sentences) std::printf("%s\n", s.c_str());
    std::printf("%s/report.html\n", folder.c_str());
}

int run_suite(const study::StudyOptions& options, model::TypeSource& types)
{
    auto suite = study::read_suite(options.scene);
    if (!suite) return fail(suite.errors());
    study::SuiteOptions how;
    how.repeat = options.repeat, how.budget = options.budget, how.tolerance = options.tolerance, how.command = options.command;
    how.allocations = &study::allocations, how.stop = &work;
    const auto lines = study::workload_of(types, *suite, how);
    if (program::is_interrupted()) return fail({reason("interrupted; nothing was run")});
    if (options.list) return list_suite(lines, how.repeat);
    if (!options.quiet) std::fprintf(stderr, "plab-study: %s\n", workload_text(lines, how.repeat).c_str());
    program::Progress line(progress_to(options), std::chrono::milliseconds(0));
    how.progress = shown_by(line);
    auto done = study::run_suite(types, *suite, how, options.out);
    line.clear();
    if (!done) return fail(done.errors());
    print_findings(*done, options.out);
    return 0;
}

int run_govern(const study::StudyOptions& options, model::TypeSource& types, model::SceneSpec scene)
{
    study::GovernPlan plan;
    plan.title = scene.settings.title.empty() ? options.scene : scene.settings.title;
    plan.scene = std::move(scene), plan.command = options.command, plan.governor = options.governor;
    plan.until = options.until, plan.stop = &work;
    for (const std::vector<study::Setting>& values : options.varied)
        for (const study::Setting& value : values)
        {
            if (value.is_dt()) return fail({reason("--govern varies parameters of governors, not dt")});
            plan.variants.push_back(value);
        }
    if (options.list)
    {
        const auto listed = study::governed_levels(types, plan);
        if (!listed) return fail(listed.errors());
        for (const std::string& level : listed->levels) std::printf("%s\n", level.c_str());
        std::printf("%zu components under %s (%s)\n", listed->components, listed->governor.c_str(), listed->type.c_str());
        return 0;
    }
    program::Progress line(progress_to(options), std::chrono::milliseconds(0));
    plan.progress = shown_by(line);
    auto result = study::compare_governor(types, plan);
    line.clear();
    if (!result) return fail(result.errors());
    if (auto written = study::write_govern(*result, options.out); !written) return fail(written.errors());
    print_findings(study::govern_findings(*result), options.out);
    return 0;
}

int run_verification(const study::StudyOptions& options, model::TypeSource& types)
{
    study::VerifyPlan plan;
    plan.file = options.scene, plan.command = options.command, plan.until = options.list ? 0 : options.until, plan.stop = &work;
    program::Progress line(progress_to(options), std::chrono::milliseconds(0));
    plan.progress = shown_by(line);
    auto result = study::verify_levels(types, plan);
    line.clear();
    if (!result) return fail(result.errors());
    if (options.list)
    {
        for (const study::VerifiedGovernor& g : result->governors)
            std::printf("%s (%s): %zu components, at most %g %s within %g s\n", g.id.c_str(), g.type.c_str(), g.components, g.bound,
                        g.unit.c_str(), g.interval);
        return 0;
    }
    if (auto written = study::write_verified(*result, options.out); !written) return fail(written.errors());
    for (const std::string& s : study::verify_findings(*result)) std::printf("%s\n", s.c_str());
    std::printf("%s/levels.csv\n", options.out.c_str());
    return 0;
}

int carry_out(const study::StudyOptions& options)
{
    plugins::PluginLibrary library;
    for (const Error& e : library.problems()) std::fprintf(stderr, "plab-study: %s\n", e.text().c_str());
    if (options.suite) return run_suite(options, library);
    if (options.verify_levels) return run_verification(options, library);
    auto blueprint = blueprint::read_blueprint_file(options.scene);
    if (!blueprint) return fail(blueprint.errors());
    auto scene = model::compile(*blueprint, library);
    if (!scene) return fail(scene.errors());
    if (options.govern) return run_govern(options, library, scene.take());
    study::Plan plan = plan_of(options, scene.take());
    if (options.list) return list(plan, library);
    if (auto fine = study::check_swaps(library, plan); !fine) return fail(fine.errors(), 2);
    program::Progress line(progress_to(options), std::chrono::milliseconds(0));
    plan.progress = shown_by(line);
    auto result = study::run_study(library, plan);
    line.clear();
    if (!result) return fail(result.errors());
    if (auto written = study::write_all(*result, options.out); !written) return fail(written.errors());
    print_findings(study::findings(*result), options.out);
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    study::StudyOptions options;
    if (const auto end = study::parse_options(argc, argv, options))
    {
        std::fputs(end->text.c_str(), end->exit_code == 0 ? stdout : stderr);
        return end->exit_code;
    }
    program::call_on_signal([] { work.ask(); });
    program::catch_signals();
    return options.list_exact ? list_exact() : carry_out(options);
}
