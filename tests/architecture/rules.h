/// Checks files against table.h. A complaint reads like a compiler's: "file:line: what is wrong".
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace plab::architecture
{

struct File
{
    std::string path;  ///< below the root, with '/'
    std::string text;
};
using Complaints = std::vector<std::string>;
using Paths = std::set<std::string, std::less<>>;

/// All text files of the project that hold code, data or prose, by path.
std::vector<File> read_tree(const std::string& root);
Paths paths_of(const std::vector<File>& files);
/// C++: what the rules about sources are for.
bool is_source(std::string_view path);

Complaints check_includes(const File& file, const Paths& known);
/// Files that include one another in a circle, a header and its source taken as one: "a -> b -> a".
Complaints check_circles(const std::vector<File>& files);
Complaints check_length(const File& file, int limit);
Complaints check_leftovers(const File& file);
Complaints check_machine_paths(const File& file);
/// Each folder of server/ and interactions/ that builds something has a README.md.
Complaints check_readmes(const Paths& known);

}  // namespace plab::architecture
