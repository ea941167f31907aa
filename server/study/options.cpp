#include "study/options.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "completion/scene_values.h"
#include "model/numbers.h"
#include "program/installation.h"

namespace plab::study
{
namespace
{

constexpr const char* kExamples = R"(Examples:
  plab-study scenes/studies/projectile.xml --vary solver=SemiImplicitEuler,RungeKutta4 --vary dt=1/60,1/120,1/240
             --reference exact:parabola --until 2 -o out
  plab-study scenes/studies/bounce.xml --vary contact.resolution=None,Bisection,LocalBisection --vary dt=1/60,1/240,1/960
             --reference exact:bounce --quantity ball.position.z --until 2 -o out
  plab-study scenes/fan_and_balloons.xml --vary gears=Assign,Impulse,Graph --vary dt=1/120,1/240 --until 5 -o out
  plab-study SCENE --algorithm "penalty: contact.response=Penalty contact.resolution=None" --algorithm "impulse: contact.response=Impulse"
             --vary dt=1/60,1/240 --until 5 -o out
  plab-study SCENE --swap 2s:contact.response=None --vary dt=1/60,1/120 --until 5 -o out
  plab-study --suite -o out                                       the catalogue of this installation; --list shows its size
  plab-study --suite my/suite.json --repeat 1 -o out
  plab-study scenes/city.xml --govern '*' --until 10 -o out       governors against one level of detail for all
  plab-study scenes/levels/springs.xml --govern --vary 'lod.pixels=0.5 20,0.5 60' --until 5 -o out     the same with other settings too
  plab-study scenes/levels/chains.xml --verify-levels --until 10 -o out    are the true errors of levels below the bound?
  plab-study run.mcap --verify-levels -o out                      the same of a recorded run

DIR then holds report.html (open it in a browser), results.csv, results.json, reference.csv and the pictures.
Exit codes: 0 done (a run that fails is a result), 1 nothing could be studied, 2 wrong usage, 130 Ctrl-C, 143 SIGTERM.)";

/// Option texts before they are parsed.
struct Texts
{
    std::vector<std::string> vary, algorithms, swaps, scales;
    std::string reference = "auto", reference_algorithm, until, floor, budget, tolerance;
};

Result<double> positive(const std::string& name, const std::string& text)
{
    const auto v = model::parse_real(text);
    if (!v || !(*v > 0) || *v > 1e12) return reason(name + " needs a positive number, not '" + text + "'");
    return v;
}

Result<void> understand(const Texts& texts, StudyOptions& out)
{
    for (const std::string& text : texts.vary)
    {
        auto v = parse_vary(text);
        if (!v) return v.errors();
        out.varied.push_back(v.take());
    }
    for (const std::string& text : texts.algorithms)
    {
        auto v = parse_algorithm(text);
        if (!v) return v.errors();
        out.algorithms.push_back(v.take());
    }
    if (auto fine = check_settings(out.algorithms, out.varied); !fine) return fine;
    for (const std::string& text : texts.swaps)
    {
        auto v = parse_swap(text);
        if (!v) return v.errors();
        out.swaps.push_back(v.take());
    }
    for (const std::string& text : texts.scales)
    {
        const std::size_t equal = text.rfind('=');
        const auto v = positive("--scale", equal == std::string::npos ? "" : text.substr(equal + 1));
        if (!v) return reason("--scale needs ID.field=LENGTH with a positive number, not '" + text + "'");
        out.scales[text.substr(0, equal)] = *v;
    }
    out.reference = parse_reference(texts.reference);
    if (!texts.reference_algorithm.empty())
    {
        if (out.reference.kind != ReferencePlan::Kind::Auto) return reason("--reference-algorithm requires --reference auto");
        auto algorithm = parse_algorithm(texts.reference_algorithm);
        if (!algorithm) return algorithm.errors();
        out.reference.algorithm = algorithm.take();
    }
    if (!texts.floor.empty())
    {
        const auto z = model::parse_real(texts.floor);
        if (!z) return reason("--floor needs a height in m, not '" + texts.floor + "'");
        out.floor = *z;
    }
    for (const auto& [name, text, value] :
         {std::tuple("--until", &texts.until, &out.until), std::tuple("--budget", &texts.budget, &out.budget),
          std::tuple("--tolerance", &texts.tolerance, &out.tolerance)})
    {
        if (text->empty()) continue;
        const auto v = positive(name, *text);
        if (!v) return v.errors();
        *value = *v;
    }
    return {};
}

constexpr const char* kUsualSuite = "scenes/studies/suite.json";

/// The catalogue of the current folder, or of the tree or installation that the program belongs to; "": there is none.
std::string usual_suite()
{
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::exists(kUsualSuite, ignored)) return kUsualSuite;
    const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    for (const char* up : {"..", "../..", "../share/plab"})
        if (const fs::path file = (folder / up / kUsualSuite).lexically_normal(); fs::exists(file, ignored)) return file.string();
    return {};
}

std::string typed(int argc, char** argv)
{
    std::string out = "plab-study";
    for (int i = 1; i < argc; ++i)
    {
        const std::string word = argv[i];
        const bool quote = word.find_first_of(" \t;&|<>()$*?\"") != std::string::npos;
        out += quote ? " '" + word + "'" : " " + word;
    }
    return out;
}

void add_study_options(CLI::App& app, StudyOptions& options, Texts& texts, std::string& suite)
{
    const auto many = [&](const char* name, std::vector<std::string>& into, const char* what)
    { app.add_option(name, into, what)->take_all()->allow_extra_args(false); };
    app.add_option("scene", options.scene, "blueprint (XML)");
    many("--vary", texts.vary,
         "ID=TypeA,TypeB or ID.param=v1,v2 or dt=1/30,1/60: values to vary (may be repeated: all combinations); with --govern: a governed "
         "run more for each value of a parameter of a governor");
    many("--algorithm", texts.algorithms,
         "[NAME:] ID=Type ID.param=value ...: settings that belong together (may be repeated); each is combined with all of --vary");
    app.add_option("--reference", texts.reference,
                   "auto (finest algorithm, extrapolated), exact:NAME[:key=value,..], none, or a CSV file; default: auto");
    app.add_option("--reference-algorithm", texts.reference_algorithm,
                   "ID=Type dt=..: the algorithm that auto extrapolates; default: the highest of --vary");
    many("--quantity", options.quantities, "ID.field to compare, such as ball.position (may be repeated); default: positions and angles");
    many("--scale", texts.scales, "ID.field=A: the length a of the mixed error |y - r|/(a + |r|); default: how far the reference moves");
    app.add_option("--until", texts.until, "simulated seconds")->type_name("T");
    app.add_option("--repeat", options.repeat, "timed runs of each combination, interleaved")->check(CLI::Range(1, 1000));
    app.add_option("--budget", texts.budget,
                   "CPU-time limit of one run in seconds; a run that needs more is stopped, with the result 'too slow'")
        ->type_name("S");
    app.add_option("--floor", texts.floor, "height z in m; a body whose centre gets below it counts as fallen through")->type_name("Z");
    many("--swap", texts.swaps,
         "STEP:ID=TYPE or TIME:ID=TYPE, such as 0.5s:..: exchange a component in every run, before that step or at that time (may be "
         "repeated)");
    app.add_option("-o,--out", options.out, "folder for report.html, results.csv, results.json and the pictures")->type_name("DIR");
    app.add_option("--suite", suite,
                   "a catalogue of studies (JSON) instead of a scene; without FILE: scenes/studies/suite.json, of here or of this "
                   "installation")
        ->expected(0, 1)
        ->type_name("[FILE]");
    app.add_option("--tolerance", texts.tolerance, "suite: an error up to here counts as solved; default: 1e-6");
    app.add_option(
           "--govern", options.governor,
           "compare a governor of the scene (its id, or a pattern for several; default: the first one) with one level of detail for all: "
           "error in a viewer's picture against CPU time")
        ->expected(0, 1)
        ->type_name("[ID]");
    app.add_flag("--verify-levels", options.verify_levels,
                 "check the governors that keep an error below a bound: the true errors of the levels in a run of the scene, or in a "
                 "recording (.mcap)");
    app.add_flag("--list", options.list,
                 "print the combinations, or the studies of a suite and their approximate duration, and run nothing");
    app.add_flag("--list-exact", options.list_exact, "print the closed forms that exact:NAME knows");
    auto* const quiet = app.add_flag("--quiet", options.quiet, "print no progress on standard error");
    app.add_flag("--progress", options.progress, "print the progress every five seconds on standard error, even if that is not a terminal")
        ->excludes(quiet);
}

}  // namespace

std::optional<ParseEnd> parse_options(int argc, char** argv, StudyOptions& options)
{
    CLI::App app{"plab-study: error against run time, for one scene and many algorithms", "plab-study"};
    app.footer(kExamples);
    app.set_version_flag("--version", std::string("plab-study ") + PLAB_VERSION);
    Texts texts;
    std::string suite;
    add_study_options(app, options, texts, suite);
    if (auto end = program::parse_command_line(app, argc, argv, PLAB_VERSION, &completion::scene_values)) return end;
    options.scene = program::file_or_installed(options.scene);
    options.suite = app.count("--suite") > 0, options.govern = app.count("--govern") > 0;
    if (options.govern && (options.suite || !texts.algorithms.empty() || !texts.swaps.empty()))
        return ParseEnd{2, "plab-study: --govern takes its levels from the governor: leave --suite, --algorithm and --swap out\n"};
    if (options.verify_levels &&
        (options.govern || options.suite || !texts.vary.empty() || !texts.algorithms.empty() || !texts.swaps.empty()))
        return ParseEnd{
            2, "plab-study: --verify-levels runs the scene as it is: leave --govern, --suite, --vary, --algorithm and --swap out\n"};
    if (options.suite && !options.scene.empty()) return ParseEnd{2, "plab-study: --suite has its own scenes: leave SCENE out\n"};
    if (options.suite) options.scene = suite.empty() ? usual_suite() : suite;
    if (options.suite && options.scene.empty())
        return ParseEnd{
            2, std::string("plab-study: --suite without FILE: neither this folder nor this installation has a ") + kUsualSuite + "\n"};
    if (options.list_exact) return {};
    if (options.scene.empty()) return ParseEnd{2, "plab-study: needs a scene; see plab-study --help\n"};
    if (auto understood = understand(texts, options); !understood) return ParseEnd{2, "plab-study: " + understood.error().text() + "\n"};
    const bool recorded = options.verify_levels && options.scene.ends_with(".mcap");
    if (!options.suite && !options.list && !recorded && options.until < 0)
        return ParseEnd{2, "plab-study: needs --until T, in simulated seconds\n"};
    if (!options.list && options.out.empty()) return ParseEnd{2, "plab-study: needs -o DIR, the folder for its results\n"};
    options.command = typed(argc, argv);
    return {};
}

}  // namespace plab::study
