// Stiff and extreme cases by algorithms: prints the matrix, checks it against expected.txt, renews table and document.
//
//   stability [--all] [--case NAME] [--algorithm NAME] [--value VALUE] [--print] [--update] [--write FILE.md]
//
// Without --all or a selection: the quick cells. --case, --algorithm and --value select cells by the parts of their names in expected.txt,
// as in --case mass_head_on --algorithm "Rows, SoftStep" --value 1e+04. --print shows the matrix; without it only differences from the
// table are shown, and the program fails if there are any. --update stores the measured results. --write renders the table.
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

#include "cell.h"
#include "page.h"
#include "table.h"
#include "trial.h"

using namespace plab::stability;

namespace
{

struct StabilityOptions
{
    bool all = false, print = false, update = false;
    std::string which_case, algorithm, value;  ///< of the cells to run; empty: all
    std::string write;

    bool selects() const { return !which_case.empty() || !algorithm.empty() || !value.empty(); }
};

bool parse(int argc, char** argv, StabilityOptions& out)
{
    for (int i = 1; i < argc; ++i)
    {
        const std::string a = argv[i];
        const bool more = i + 1 < argc;
        if (a == "--all")
            out.all = true;
        else if (a == "--print")
            out.print = true;
        else if (a == "--update")
            out.update = true;
        else if (a == "--case" && more)
            out.which_case = argv[++i];
        else if (a == "--algorithm" && more)
            out.algorithm = argv[++i];
        else if (a == "--value" && more)
            out.value = argv[++i];
        else if (a == "--write" && more)
            out.write = argv[++i];
        else
            return false;
    }
    return true;
}

bool takes_part(const StabilityOptions& options, const Case& c, std::size_t r, std::size_t v)
{
    const auto fits = [](const std::string& selected, const std::string& name) { return selected.empty() || selected == name; };
    if (options.selects())
        return fits(options.which_case, c.name) && fits(options.algorithm, c.algorithms[r]) && fits(options.value, c.values[v]);
    return options.all || c.quick(r, v);
}

/// Runs the selected cells of one case; counts them in `cells`, and returns the number of those that differ from the table.
int run(const StabilityOptions& options, const Case& c, Table& table, int& cells)
{
    int differences = 0;
    for (std::size_t r = 0; r < c.algorithms.size(); ++r)
        for (std::size_t v = 0; v < c.values.size(); ++v)
        {
            if (!takes_part(options, c, r, v)) continue;
            ++cells;
            const Outcome measured = run_cell(c, r, v);
            const Outcome* expected = table.find(key_of(c, r, v));
            const bool same = expected && agree(*expected, measured);
            if (options.print)
                std::printf("%-14s %-24s %-10s %s\n", c.name.c_str(), c.algorithms[r].c_str(), c.values[v].c_str(),
                            to_line(measured).c_str());
            else if (!same)
                std::printf("%s\n  expected %s\n  measured %s\n", key_of(c, r, v).c_str(),
                            expected ? to_line(*expected).c_str() : "nothing", to_line(measured).c_str());
            std::fflush(stdout);
            differences += same ? 0 : 1;
            if (options.update && !same) table.set(key_of(c, r, v), measured);
        }
    return differences;
}

const char* const kTableFile = PLAB_SOURCE_DIR "/tests/stability/expected.txt";
const char* const kDocument = PLAB_SOURCE_DIR "/server/docs/stability.md";

/// Whether the document agrees with the table.
bool document_is_current(const std::string& page)
{
    std::ifstream file(kDocument);
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (text == page) return true;
    std::printf("server/docs/stability.md is not what the table says: stability --write server/docs/stability.md\n");
    return false;
}

}  // namespace

int main(int argc, char** argv)
{
    StabilityOptions options;
    if (!parse(argc, argv, options))
    {
        std::fprintf(stderr,
                     "usage: stability [--all] [--case NAME] [--algorithm NAME] [--value VALUE] [--print] [--update] [--write FILE.md]\n");
        return 2;
    }
    load_plugins();
    auto cases = all_cases();
    Table table = Table::read(kTableFile);
    int differences = 0, cells = 0;
    const bool only_write = !options.write.empty() && !options.all && !options.update && !options.selects();
    if (!only_write)
        for (const Case& c : cases) differences += run(options, c, table, cells);
    if (options.selects() && cells == 0)
    {
        std::fprintf(stderr, "no cell has this case, algorithm and value\n");
        return 2;
    }
    if (options.update && !table.write(kTableFile, cases)) return 2;
    if (!options.write.empty())
    {
        std::ofstream file(options.write);
        file << page(cases, table);
        if (!file) return 2;
    }
    if (options.update || options.print || !options.write.empty()) return 0;
    if (differences > 0) std::printf("%d cells are not as in expected.txt; if that is right: stability --all --update\n", differences);
    return differences == 0 && document_is_current(page(cases, table)) ? 0 : 1;
}
