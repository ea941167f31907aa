// Stiff and extreme cases by algorithms: prints the matrix, checks it against expected.txt, renews table and document.
//
//   stability [--all] [--case NAME] [--print] [--update] [--write FILE.md]
//
// Without --all or --case: the quick cells. --print shows the matrix; without it only differences from the table are shown, and the
// program fails if there are any. --update stores the measured results. --write renders the table.
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
    std::string only, write;
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
            out.only = argv[++i];
        else if (a == "--write" && more)
            out.write = argv[++i];
        else
            return false;
    }
    return true;
}

bool takes_part(const StabilityOptions& options, const Case& c, std::size_t r, std::size_t v)
{
    if (!options.only.empty()) return c.name == options.only;
    return options.all || c.quick(r, v);
}

/// Runs the selected cells of one case; counts those that differ from the table.
int run(const StabilityOptions& options, const Case& c, Table& table)
{
    int differences = 0;
    for (std::size_t r = 0; r < c.algorithms.size(); ++r)
        for (std::size_t v = 0; v < c.values.size(); ++v)
        {
            if (!takes_part(options, c, r, v)) continue;
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
        std::fprintf(stderr, "usage: stability [--all] [--case NAME] [--print] [--update] [--write FILE.md]\n");
        return 2;
    }
    load_plugins();
    auto cases = all_cases();
    Table table = Table::read(kTableFile);
    int differences = 0;
    const bool only_write = !options.write.empty() && !options.all && !options.update && options.only.empty();
    if (!only_write)
        for (const Case& c : cases) differences += run(options, c, table);
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
