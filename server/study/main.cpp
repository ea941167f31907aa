// plab-study: error against run time, offline. Put together here: command line, plugins, scene, study, files.
#include <unistd.h>

#include <cstdio>

#include "blueprint/reader.h"
#include "model/compile.h"
#include "plugins/library.h"
#include "study/allocations.h"
#include "study/exact/exact.h"
#include "study/options.h"
#include "study/suite.h"
#include "study/write.h"

namespace
{

using namespace plab;

int fail(const Errors& errors, int code = 1)
{
    for (const Error& e : errors) std::fprintf(stderr, "plab-study: %s\n", e.text().c_str());
    return code;
}

/// One line that is written over on a terminal, a line each elsewhere.
void show_progress(const std::string& text)
{
    if (isatty(STDERR_FILENO) != 0)
        std::fprintf(stderr, "\r\x1b[K%.110s", text.c_str());
    else
        std::fprintf(stderr, "%s\n", text.c_str());
}

void end_progress()
{
    if (isatty(STDERR_FILENO) != 0) std::fputs("\r\x1b[K", stderr);
}

int list_exact()
{
    for (const study::ExactEntry& e : study::exact_registry())
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

study::Plan plan_of(const study::Options& options, model::SceneSpec scene)
{
    study::Plan plan;
    plan.scene = std::move(scene), plan.command = options.command, plan.combinations = study::combine(options.rungs, options.varied);
    plan.reference = options.reference, plan.repeat = options.repeat, plan.scales = options.scales;
    plan.run.until = options.until, plan.run.quantities = options.quantities, plan.swaps = options.swaps;
    plan.run.floor = options.floor, plan.run.budget = options.budget, plan.run.allocations = &study::allocations;
    if (!options.quiet) plan.progress = &show_progress;
    return plan;
}

void print_findings(const std::vector<std::string>& sentences, const std::string& folder)
{
    for (const std::string& s : sentences) std::printf("%s\n", s.c_str());
    std::printf("%s/report.html\n", folder.c_str());
}

int run_suite(const study::Options& options, model::TypeSource& types)
{
    auto suite = study::read_suite(options.scene);
    if (!suite) return fail(suite.errors());
    study::SuiteOptions how;
    how.repeat = options.repeat, how.budget = options.budget, how.tolerance = options.tolerance, how.command = options.command;
    how.allocations = &study::allocations;
    if (!options.quiet) how.progress = &show_progress;
    auto done = study::run_suite(types, *suite, how, options.out);
    end_progress();
    if (!done) return fail(done.errors());
    print_findings(*done, options.out);
    return 0;
}

int carry_out(const study::Options& options)
{
    plugins::PluginLibrary library;
    for (const Error& e : library.problems()) std::fprintf(stderr, "plab-study: %s\n", e.text().c_str());
    if (options.suite) return run_suite(options, library);
    auto blueprint = blueprint::read_blueprint_file(options.scene);
    if (!blueprint) return fail(blueprint.errors());
    auto scene = model::compile(*blueprint, library);
    if (!scene) return fail(scene.errors());
    const study::Plan plan = plan_of(options, scene.take());
    if (options.list) return list(plan, library);
    if (auto fine = study::check_swaps(library, plan); !fine) return fail(fine.errors(), 2);
    auto result = study::run_study(library, plan);
    end_progress();
    if (!result) return fail(result.errors());
    if (auto written = study::write_all(*result, options.out); !written) return fail(written.errors());
    print_findings(study::findings(*result), options.out);
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    study::Options options;
    if (const auto end = study::parse_options(argc, argv, options))
    {
        std::fputs(end->text.c_str(), end->exit_code == 0 ? stdout : stderr);
        return end->exit_code;
    }
    return options.list_exact ? list_exact() : carry_out(options);
}
