/// Checks files against table.h. A complaint reads like a compiler's: "file:line: what is wrong".
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "table.h"

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
/// The same of the folders that these files stand in, whatever the table allows.
Complaints check_folder_circles(const std::vector<File>& files);
/// Layers that may include one another in a circle by the table alone. A layer that names a folder means the folders in it too.
Complaints check_table(const std::vector<Layer>& table);
/// Each folder with sources in server/simulation, interactions, clients and idl is a layer of its own, or is what an "x/*" stands for.
Complaints check_own_rows(const Paths& known);
/// A class has no friends that other folders define.
Complaints check_friends(const std::vector<File>& files);
Complaints check_length(const File& file, int limit);
Complaints check_leftovers(const File& file);
Complaints check_machine_paths(const File& file);
/// Each folder of server/ and interactions/ that builds something has a README.md.
Complaints check_readmes(const Paths& known);

}  // namespace plab::architecture
