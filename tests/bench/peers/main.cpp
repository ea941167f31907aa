// Peers side by side with pLab: error against processor time, in one command (server/docs/peers.md).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "bench/peers/check.h"
#include "bench/peers/figure.h"
#include "bench/peers/results.h"

using namespace plab::peers;

namespace
{

constexpr const char* kUsage = R"(Usage: bench_peers [options]

  --case LIST     only cases whose ids begin so: a,b,d-elastic (default: all)
  --engine LIST   of ode, bullet, simbody, plab (default: all)
  --only TEXT     only runs whose label holds TEXT
  --repeat N      interleaved repetitions, of which the median is taken (default: 5)
  --limit S       s of processor time after which a run is cut (default: as the case says)
  --quick         one repetition, limit 10 s, only steps down to 1/240
  -o DIR          where results go (default: peers)
  --list          prints the cases and their runs, and measures nothing
  --check         measures runs whose figures are known, and compares

Writes DIR/results.csv, results.json, summary.md, and for each case CASE.svg and CASE.png.
)";

struct PeerOptions
{
    std::vector<std::string> cases, engines;
    std::string only, folder = "peers";
    int repeat = 5;
    double limit = 0;
    bool quick = false, list = false, check = false, help = false;
    std::string complaint;
};

std::vector<std::string> split(const std::string& text)
{
    std::vector<std::string> out;
    for (std::size_t begin = 0; begin <= text.size();)
    {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        if (end > begin) out.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return out;
}

/// Takes the option `name` with its value; false if it is not an option of this program.
bool take(PeerOptions& o, std::string_view name, const std::string& value)
{
    if (name == "--case") return o.cases = split(value), true;
    if (name == "--engine") return o.engines = split(value), true;
    if (name == "--only") return o.only = value, true;
    if (name == "--repeat") return o.repeat = std::max(1, std::atoi(value.c_str())), true;
    if (name == "--limit") return o.limit = std::atof(value.c_str()), true;
    if (name == "-o") return o.folder = value, true;
    return false;
}

PeerOptions parse(int argc, char** argv)
{
    PeerOptions o;
    for (int i = 1; i < argc; ++i)
    {
        const std::string_view word = argv[i];
        if (word == "--quick")
            o.quick = true, o.repeat = 1, o.limit = 10;
        else if (word == "--list")
            o.list = true;
        else if (word == "--check")
            o.check = true;
        else if (word == "--help" || word == "-h")
            o.help = true;
        else if (i + 1 >= argc || !take(o, word, argv[i + 1]))
            o.complaint = "unknown option, or one without value: " + std::string(word);
        else
            ++i;
    }
    return o;
}

std::vector<Run> runs_of(const Case& which, const PeerOptions& options, std::vector<std::string>& notes)
{
    struct Named
    {
        const char* name;
        Adapter runs;
    };
    std::vector<Run> all;
    for (const Named& adapter :
         {Named{"ode", ode_runs}, Named{"bullet", bullet_runs}, Named{"simbody", simbody_runs}, Named{"plab", plab_runs}})
    {
        const bool wanted = options.engines.empty() || std::count(options.engines.begin(), options.engines.end(), adapter.name) > 0;
        if (!wanted) continue;
        for (Run& run : adapter.runs(which, notes)) all.push_back(std::move(run));
    }
    const auto unwanted = [&options](const Run& r)
    { return r.label().find(options.only) == std::string::npos || (options.quick && r.step.seconds() < 1 / 240.5); };
    std::erase_if(all, unwanted);
    return all;
}

double median(std::vector<double> v)
{
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

/// Expensive runs are not repeated as often: their noise is small, and the command has to end.
int repetitions_for(const Measurement& first, const Case& which, int wanted)
{
    const double seconds = first.cost * 1e-3 * which.scenes[0].duration * static_cast<double>(which.scenes.size());
    if (first.outcome != Outcome::Done || seconds > 20) return 1;
    return seconds > 2 ? std::min(wanted, 3) : wanted;
}

void print_point(const Case& which, const Point& p)
{
    if (p.outcome != Outcome::Done)
        std::printf("%-12s %-44s %s: %s\n", which.id.c_str(), p.run.label().c_str(), name_of(p.outcome), p.why.c_str());
    else
    {
        std::printf("%-12s %-44s %10.4g ms/s", which.id.c_str(), p.run.label().c_str(), p.cost);
        for (std::size_t m = 0; m < p.figures.size(); ++m) std::printf("  %s %.3g", which.metrics[m].name.c_str(), p.figures[m]);
        std::printf("\n");
    }
    std::fflush(stdout);
}

CaseResult compare(const Case& which, const PeerOptions& options)
{
    CaseResult result{which, {}, {}};
    std::vector<std::vector<double>> costs;
    std::vector<int> wanted;
    for (const Run& run : runs_of(which, options, result.notes))
    {
        const Measurement m = measure(which, run, Quantity::Figures);
        result.points.push_back({run, m.outcome, m.why, m.figures, m.cost, m.cost, m.memory, 1});
        costs.push_back({m.cost});
        wanted.push_back(repetitions_for(m, which, options.repeat));
        print_point(which, result.points.back());
    }
    for (int round = 1; round < options.repeat; ++round)
        for (std::size_t i = 0; i < result.points.size(); ++i)
        {
            if (round >= wanted[i]) continue;
            const Measurement m = measure(which, result.points[i].run, Quantity::Cost);
            if (m.outcome == Outcome::Done) costs[i].push_back(m.cost);
        }
    for (std::size_t i = 0; i < result.points.size(); ++i)
    {
        Point& p = result.points[i];
        p.repetitions = static_cast<int>(costs[i].size());
        p.cost = median(costs[i]);
        p.cost_least = *std::min_element(costs[i].begin(), costs[i].end());
    }
    return result;
}

bool write_file(const std::string& path, const std::string& text)
{
    std::ofstream file(path, std::ios::binary);
    file << text;
    return static_cast<bool>(file.flush());
}

bool write_results(const std::string& folder, const std::vector<CaseResult>& results)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    bool good = write_file(folder + "/results.csv", csv_of(results)) && write_file(folder + "/results.json", json_of(results)) &&
                write_file(folder + "/summary.md", summary_of(results));
    good = good && draw_case(results.back(), folder + "/" + results.back().which.id);
    if (!good) std::fprintf(stderr, "bench_peers: could not write into %s\n", folder.c_str());
    return good;
}

int print_checks()
{
    bool good = true;
    std::printf("| run | figure | known | here | |\n|---|---|---:|---:|---|\n");
    for (const Checked& c : check_adapters())
    {
        std::printf("| %s | %s | %.3g | %.3g | %s |\n", c.run.c_str(), c.metric.c_str(), c.known, c.measured, c.good ? "" : "OFF");
        good = good && c.good;
    }
    return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv)
{
    const PeerOptions options = parse(argc, argv);
    if (options.help || !options.complaint.empty())
    {
        std::fputs(options.complaint.empty() ? "" : (options.complaint + "\n").c_str(), stderr);
        std::fputs(kUsage, options.help ? stdout : stderr);
        return options.help ? 0 : 2;
    }
    if (options.check) return print_checks();
    std::vector<CaseResult> results;
    for (Case& which : make_cases(options.cases))
    {
        if (options.limit > 0) which.cpu_limit = options.limit;
        if (options.list)
        {
            std::vector<std::string> notes;
            for (const Run& run : runs_of(which, options, notes)) std::printf("%s: %s\n", which.id.c_str(), run.label().c_str());
            for (const std::string& note : notes) std::printf("%s\n", note.c_str());
            continue;
        }
        results.push_back(compare(which, options));
        if (!write_results(options.folder, results)) return 1;
    }
    if (!results.empty()) std::printf("%s", summary_of(results).c_str());
    return 0;
}
