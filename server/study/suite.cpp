#include "study/suite.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "blueprint/reader.h"
#include "figures/axes.h"
#include "figures/page.h"
#include "model/compile.h"
#include "program/text_out.h"
#include "study/plot.h"
#include "study/write.h"

namespace plab::study
{
namespace
{

using Json = nlohmann::ordered_json;
using figures::Page;

Error wrong(const std::string& path, const std::string& entry, const std::string& why)
{
    return Error{{path, 0, 0}, entry.empty() ? entry : "study '" + entry + "'", why};
}

std::vector<std::string> texts(const Json& entry, const char* key)
{
    std::vector<std::string> out;
    if (entry.contains(key))
        for (const Json& t : entry[key]) out.push_back(t.get<std::string>());
    return out;
}

/// Throws the exceptions of nlohmann-json; read_suite() catches them.
Result<SuiteEntry> read_entry(const Json& entry, const std::string& path)
{
    SuiteEntry out;
    out.name = entry.at("name").get<std::string>();
    for (const auto& [key, value] : entry.items())
    {
        static const std::vector<std::string> known{
            "name",       "title", "scene", "vary",   "algorithms", "reference", "reference_algorithm",
            "quantities", "until", "floor", "ladder", "scales"};
        if (std::find(known.begin(), known.end(), key) == known.end()) return wrong(path, out.name, "unknown key '" + key + "'");
    }
    out.title = entry.value("title", out.name);
    out.scene = (std::filesystem::path(path).parent_path() / entry.at("scene").get<std::string>()).string();
    for (const std::string& text : texts(entry, "vary"))
    {
        auto v = parse_vary(text);
        if (!v) return wrong(path, out.name, v.error().reason);
        out.varied.push_back(v.take());
    }
    for (const std::string& text : texts(entry, "algorithms"))
    {
        auto v = parse_algorithm(text);
        if (!v) return wrong(path, out.name, v.error().reason);
        out.algorithms.push_back(v.take());
    }
    if (auto fine = check_settings(out.algorithms, out.varied); !fine) return wrong(path, out.name, fine.error().reason);
    out.reference = parse_reference(entry.value("reference", std::string("auto")));
    if (entry.contains("reference_algorithm"))
    {
        auto v = parse_algorithm(entry["reference_algorithm"].get<std::string>());
        if (!v) return wrong(path, out.name, v.error().reason);
        out.reference.algorithm = v.take();
    }
    if (out.reference.kind == ReferencePlan::Kind::File)
        out.reference.text = (std::filesystem::path(path).parent_path() / out.reference.text).string();
    out.quantities = texts(entry, "quantities");
    out.until = entry.at("until").get<double>();
    out.ladder = entry.value("ladder", std::string());
    if (entry.contains("floor")) out.floor = entry["floor"].get<double>();
    if (entry.contains("scales"))
        for (const auto& [quantity, length] : entry["scales"].items())
        {
            if (!(length.get<double>() > 0)) return wrong(path, out.name, "the scale of " + quantity + " is not positive");
            out.scales[quantity] = length.get<double>();
        }
    return out;
}

/// One study of the catalogue that was made, or why not.
struct Done
{
    const SuiteEntry* entry = nullptr;
    std::optional<StudyResult> result;
    std::string trouble;
};

Result<Plan> plan_of(model::TypeSource& types, const SuiteEntry& entry, const SuiteOptions& options)
{
    auto blueprint = blueprint::read_blueprint_file(entry.scene);
    if (!blueprint) return blueprint.errors();
    auto scene = model::compile(*blueprint, types);
    if (!scene) return scene.errors();
    Plan plan;
    plan.scene = scene.take(), plan.title = entry.title, plan.command = options.command;
    plan.combinations = combine(entry.algorithms, entry.varied), plan.reference = entry.reference, plan.repeat = options.repeat;
    plan.scales = entry.scales;
    plan.run.until = entry.until, plan.run.quantities = entry.quantities, plan.run.floor = entry.floor;
    plan.run.budget = options.budget, plan.run.allocations = options.allocations, plan.run.stop = options.stop;
    return plan;
}

/// `place`: "3 of 21".
Done run_entry(model::TypeSource& types, const SuiteEntry& entry, const SuiteOptions& options, const std::string& folder,
               const std::string& place)
{
    Done out;
    out.entry = &entry;
    const auto fail = [&](const Errors& errors) { out.trouble = errors.front().text(); };
    auto planned = plan_of(types, entry, options);
    if (!planned) return fail(planned.errors()), out;
    if (options.progress)
        planned->progress = [&](const std::string& text) { options.progress("study " + place + ", " + entry.name + ": " + text); };
    auto result = run_study(types, *planned);
    if (!result) return fail(result.errors()), out;
    if (auto written = write_all(*result, folder + "/" + entry.name); !written) fail(written.errors());
    out.result = result.take();
    return out;
}

/// The studies of one ladder: the best result of each algorithm in each, and the cost of the cheapest run within the tolerance.
struct Tally
{
    std::string ladder;
    std::vector<const Done*> studies;
    std::vector<std::string> algorithms;
    std::vector<std::vector<plot::Cell>> best;  ///< study by algorithm
    std::vector<std::vector<double>> cost;      ///< s per simulated second; infinite where none is within the tolerance

    std::vector<std::string> names() const
    {
        std::vector<std::string> out;
        for (const Done* d : studies) out.push_back(d->entry->name);
        return out;
    }
};

std::string ladder_of(const Done& d)
{
    if (!d.entry->ladder.empty()) return d.entry->ladder;
    std::string out;
    for (const std::string& algorithm : plot::algorithms_of(*d.result)) out += (out.empty() ? "" : ", ") + algorithm;
    return out;
}

void tally_point(const Point& p, double tolerance, plot::Cell& cell, double& cost)
{
    if (!p.record.ok() || std::isnan(p.error()))
    {
        if (std::isnan(cell.digits)) cell = {NAN, std::string(name_of(p.record.outcome)), p.record.why};
        return;
    }
    if (!(digits(p.error()) <= cell.digits))
        cell = {digits(p.error()), "", p.combination.label() + ": error " + figures::short_number(p.error())};
    if (p.error() <= tolerance && p.cpu_per_second() < cost) cost = p.cpu_per_second();
}

void fill(Tally& tally, double tolerance)
{
    for (const Done* d : tally.studies)
        for (const std::string& algorithm : plot::algorithms_of(*d->result))
            if (std::find(tally.algorithms.begin(), tally.algorithms.end(), algorithm) == tally.algorithms.end())
                tally.algorithms.push_back(algorithm);
    for (const Done* d : tally.studies)
    {
        auto& cells = tally.best.emplace_back(tally.algorithms.size(), plot::Cell{NAN, "", "not part of this study"});
        auto& cost = tally.cost.emplace_back(tally.algorithms.size(), std::numeric_limits<double>::infinity());
        for (const Point& p : d->result->points)
        {
            const auto r = static_cast<std::size_t>(std::find(tally.algorithms.begin(), tally.algorithms.end(), p.combination.algorithm) -
                                                    tally.algorithms.begin());
            tally_point(p, tolerance, cells[r], cost[r]);
        }
    }
}

std::vector<Tally> tallies_of(const std::vector<Done>& all, double tolerance)
{
    std::vector<Tally> out;
    for (const Done& d : all)
    {
        if (!d.result) continue;
        const std::string ladder = ladder_of(d);
        auto found = std::find_if(out.begin(), out.end(), [&](const Tally& t) { return t.ladder == ladder; });
        if (found == out.end()) out.emplace_back().ladder = ladder, found = std::prev(out.end());
        found->studies.push_back(&d);
    }
    for (Tally& t : out) fill(t, tolerance);
    return out;
}

std::vector<std::string> findings_of(const std::vector<Done>& all, const std::vector<Tally>& tallies, double tolerance)
{
    std::vector<std::string> out;
    std::size_t solved = 0;
    for (const Tally& t : tallies)
        for (std::size_t i = 0; i < t.studies.size(); ++i)
        {
            const auto best = std::min_element(t.cost[i].begin(), t.cost[i].end());
            const bool any = std::isfinite(*best);
            solved += any ? 1 : 0;
            out.push_back(t.studies[i]->entry->name + ": " +
                          (any ? t.algorithms[static_cast<std::size_t>(best - t.cost[i].begin())] + " is the cheapest within " +
                                     figures::short_number(tolerance) + ", " + figures::short_number(1e3 * *best) +
                                     " ms per simulated second."
                               : "no algorithm comes within " + figures::short_number(tolerance) + "."));
        }
    for (const Done& d : all)
        if (!d.trouble.empty()) out.push_back(d.entry->name + ": could not be studied: " + d.trouble);
    out.insert(out.begin(), std::to_string(solved) + " of " + std::to_string(all.size()) +
                                " problems have a run with an error of at most " + figures::short_number(tolerance) + ".");
    return out;
}

Json suite_json(const std::vector<Done>& all, const std::vector<Tally>& tallies, const std::vector<std::string>& sentences,
                double tolerance)
{
    Json out{{"schema", "plab-study-suite 1"}, {"tolerance", tolerance}, {"findings", sentences}, {"studies", Json::array()}};
    for (const Tally& t : tallies)
        for (std::size_t i = 0; i < t.studies.size(); ++i)
        {
            const SuiteEntry& entry = *t.studies[i]->entry;
            Json digits = Json::object(), cost = Json::object();
            for (std::size_t r = 0; r < t.algorithms.size(); ++r)
            {
                digits[t.algorithms[r]] = std::isnan(t.best[i][r].digits) ? Json(nullptr) : Json(t.best[i][r].digits);
                cost[t.algorithms[r]] = std::isfinite(t.cost[i][r]) ? Json(t.cost[i][r]) : Json(nullptr);
            }
            out["studies"].push_back({{"name", entry.name},
                                      {"title", entry.title},
                                      {"scene", entry.scene},
                                      {"ladder", t.ladder},
                                      {"digits", digits},
                                      {"cpu_per_simulated_second", cost}});
        }
    for (const Done& d : all)
        if (!d.trouble.empty()) out["studies"].push_back({{"name", d.entry->name}, {"scene", d.entry->scene}, {"trouble", d.trouble}});
    return out;
}

/// A picture as SVG and PNG.
Result<void> write_picture(const std::string& file, const figures::Drawing& drawing)
{
    if (auto written = program::write_file(file + ".svg", drawing.svg(true)); !written) return written;
    return drawing.write_png(file + ".png");
}

Result<void> add_tally(Page& page, const Tally& t, const SuiteOptions& options, const std::string& folder, const std::string& number)
{
    page.heading(t.ladder);
    // Algorithms as rows: they are many, and their names long.
    std::vector<std::vector<plot::Cell>> cells(t.algorithms.size());
    for (std::size_t r = 0; r < t.algorithms.size(); ++r)
        for (const std::vector<plot::Cell>& study : t.best) cells[r].push_back(study[r]);
    const figures::Drawing map = plot::heat_map("Best digits", t.algorithms, t.names(), cells);
    page.figure(map, "Correct digits of each algorithm's best run. A pale cell: not part of that problem, or no result.");
    if (auto written = write_picture(folder + "/digits" + number, map); !written) return written;
    if (t.studies.size() > 1)
    {
        const figures::Drawing profile = plot::performance_profile("Performance profile", t.algorithms, t.cost);
        page.figure(profile, "After Dolan and Moré (2002): the share of these problems that an algorithm solves to " +
                                 figures::short_number(options.tolerance) +
                                 " within that multiple of the cheapest algorithm's cost. Runs without a result solve nothing.");
        if (auto written = write_picture(folder + "/profile" + number, profile); !written) return written;
    }
    for (const Done* d : t.studies) page.link(d->entry->name + "/report.html", d->entry->title);
    return {};
}

Result<void> write_suite(const Suite& suite, const std::vector<Done>& all, const SuiteOptions& options,
                         const std::vector<std::string>& sentences, const std::vector<Tally>& tallies, const std::string& folder)
{
    Page page(suite.title,
              std::to_string(suite.entries.size()) + " problems, grouped by ladder; each algorithm at all of its step lengths.");
    page.list(sentences);
    for (std::size_t i = 0; i < tallies.size(); ++i)
        if (auto added = add_tally(page, tallies[i], options, folder, "-" + std::to_string(i + 1)); !added) return added;
    page.heading("To do it again");
    page.code(options.command);
    const std::string json = suite_json(all, tallies, sentences, options.tolerance).dump(1) + "\n";
    if (auto written = program::write_file(folder + "/suite.json", json); !written) return written;
    return program::write_file(folder + "/report.html", page.html());
}

}  // namespace

Result<Suite> read_suite(const std::string& path)
{
    std::ifstream file(path);
    if (!file) return reason("cannot read the suite " + path);
    Suite out;
    out.file = path;
    try
    {
        const Json json = Json::parse(file);
        out.title = json.value("title", std::string("A catalogue of studies"));
        for (const Json& entry : json.at("studies"))
        {
            auto read = read_entry(entry, path);
            if (!read) return read.errors();
            out.entries.push_back(read.take());
        }
    }
    catch (const Json::exception& e)
    {
        return reason(path + ": " + e.what() + "; a suite is {\"studies\": [{\"name\", \"scene\", \"vary\", \"until\", ...}]}");
    }
    if (out.entries.empty()) return reason(path + " names no studies");
    return out;
}

std::vector<SuiteLine> workload_of(model::TypeSource& types, const Suite& suite, const SuiteOptions& options)
{
    std::vector<SuiteLine> out;
    for (const SuiteEntry& entry : suite.entries)
    {
        auto plan = plan_of(types, entry, options);
        if (plan)
            out.push_back({&entry, workload_of(types, *plan), ""});
        else
            out.push_back({&entry, {}, plan.error().text()});
    }
    return out;
}

Result<std::vector<std::string>> run_suite(model::TypeSource& types, const Suite& suite, const SuiteOptions& options,
                                           const std::string& folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return reason("cannot make the folder " + folder + ": " + error.message());
    std::vector<Done> all;
    for (std::size_t i = 0; i < suite.entries.size(); ++i)
    {
        const std::string place = std::to_string(i + 1) + " of " + std::to_string(suite.entries.size());
        all.push_back(run_entry(types, suite.entries[i], options, folder, place));
        if (options.stop != nullptr && options.stop->asked())
            return reason("study " + place + ", " + suite.entries[i].name + ": " + all.back().trouble + ". " + std::to_string(i) +
                          " studies of the suite are in " + folder + ", each in its folder; " + folder + "/report.html is not written");
    }
    const std::vector<Tally> tallies = tallies_of(all, options.tolerance);
    std::vector<std::string> sentences = findings_of(all, tallies, options.tolerance);
    if (auto written = write_suite(suite, all, options, sentences, tallies, folder); !written) return written.errors();
    return sentences;
}

}  // namespace plab::study
