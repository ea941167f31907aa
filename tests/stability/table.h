/// The expected verdicts of expected.txt: one line per cell.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "case.h"

namespace plab::stability
{

/// "case | algorithm | value"
std::string key_of(const Case& which, std::size_t algorithm, std::size_t value);

class Table
{
public:
    static Table read(const std::string& file);
    const Outcome* find(const std::string& key) const;
    void set(const std::string& key, const Outcome& outcome) { cells_[key] = outcome; }
    /// In the order of the cases; cells of cases that no longer exist are left out.
    bool write(const std::string& file, const std::vector<Case>& cases) const;

private:
    std::map<std::string, Outcome> cells_;
};

}  // namespace plab::stability
