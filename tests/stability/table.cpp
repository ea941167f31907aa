#include "table.h"

#include <fstream>

namespace plab::stability
{

std::string key_of(const Case& which, std::size_t algorithm, std::size_t value)
{
    return which.name + " | " + which.algorithms[algorithm] + " | " + which.values[value];
}

Table Table::read(const std::string& file)
{
    Table out;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
    {
        const std::size_t bar = line.find(" = ");
        if (line.empty() || line[0] == '#' || bar == std::string::npos) continue;
        if (const auto outcome = from_line(std::string_view(line).substr(bar + 3))) out.cells_[line.substr(0, bar)] = *outcome;
    }
    return out;
}

const Outcome* Table::find(const std::string& key) const
{
    const auto found = cells_.find(key);
    return found == cells_.end() ? nullptr : &found->second;
}

bool Table::write(const std::string& file, const std::vector<Case>& cases) const
{
    std::ofstream out(file);
    out << "# case | algorithm | value = verdict, error, why. Renewed by: build/bin/stability --all --update\n";
    for (const Case& c : cases)
        for (std::size_t r = 0; r < c.algorithms.size(); ++r)
            for (std::size_t v = 0; v < c.values.size(); ++v)
                if (const Outcome* cell = find(key_of(c, r, v))) out << key_of(c, r, v) << " = " << to_line(*cell) << "\n";
    return static_cast<bool>(out);
}

}  // namespace plab::stability
