#include "rules.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <sstream>

namespace plab::architecture
{
namespace
{

namespace fs = std::filesystem;

bool inside(std::string_view path, std::string_view folder)
{
    return path.size() > folder.size() && path.substr(0, folder.size()) == folder && path[folder.size()] == '/';
}

std::string folder_of(std::string_view path)
{
    const std::size_t slash = path.rfind('/');
    return std::string(slash == std::string_view::npos ? std::string_view{} : path.substr(0, slash));
}

struct Home
{
    const Layer* layer;
    std::string root;  // the layer's folder; of "x/*" the folder in x
};

std::optional<Home> home_of(std::string_view path)
{
    for (const Layer& layer : layers())
    {
        if (!layer.folder.ends_with("/*"))
        {
            if (inside(path, layer.folder)) return Home{&layer, std::string(layer.folder)};
            continue;
        }
        const std::string_view parent = layer.folder.substr(0, layer.folder.size() - 2);
        const std::size_t slash = inside(path, parent) ? path.find('/', parent.size() + 1) : std::string_view::npos;
        if (slash != std::string_view::npos) return Home{&layer, std::string(path.substr(0, slash))};
    }
    return {};
}

std::optional<std::string> resolve(const std::string& from, const Home& home, const std::string& include, const Paths& known)
{
    if (std::ranges::find(generated_files(), include) != generated_files().end()) return include;
    std::vector<std::string> roots{folder_of(from), home.root, folder_of(home.root)};
    roots.insert(roots.end(), include_roots().begin(), include_roots().end());
    for (const std::string& root : roots)
    {
        const std::string path = fs::path(root.empty() ? include : root + "/" + include).lexically_normal().generic_string();
        if (known.contains(path)) return path;
    }
    return {};
}

bool is_third_party(const Layer& layer, std::string_view header)
{
    return std::ranges::any_of(layer.third_party,
                               [&](std::string_view name) { return name.ends_with('/') ? header.starts_with(name) : header == name; });
}

std::string judge_system(const File& file, const Home& home, const std::string& header)
{
    if (std::ranges::find(standard_headers(), header) != standard_headers().end()) return {};
    if (!is_third_party(*home.layer, header)) return home.root + " may not include <" + header + ">";
    if (!home.layer->headers_too && file.path.ends_with(".h")) return "<" + header + "> stays in sources, a header may not show it";
    return {};
}

std::string judge_own(const File& file, const Home& home, const std::string& include, const Paths& known)
{
    // Tests see plugins' own folders through the include paths of their CMakeLists.txt; whatever they find they may
    // include.
    if (home.root == "tests") return {};
    const auto path = resolve(file.path, home, include, known);
    if (!path) return "\"" + include + "\" is no file of this project";
    if (inside(*path, home.root) || inside(*path, "server/base")) return {};
    for (const std::string_view folder : home.layer->may_include)
        if (inside(*path, folder)) return {};
    return home.root + " may not include \"" + include + "\" (" + *path + ")";
}

/// What stands behind #include in a line; empty: it is no such line.
std::string operand_of(const std::string& line)
{
    static const std::regex directive(R"(^\s*#\s*include\s*(.*)$)");
    std::smatch match;
    return std::regex_match(line, match, directive) ? match[1].str() : "";
}

/// A header and its source, as one.
std::string unit_of(const std::string& path) { return path.substr(0, path.rfind('.')); }

/// Which units each unit includes, in any of its files.
std::map<std::string, std::set<std::string>> units_included(const std::vector<File>& files)
{
    const Paths known = paths_of(files);
    std::map<std::string, std::set<std::string>> out;
    for (const File& file : files)
    {
        const auto home = home_of(file.path);
        if (!home || !is_source(file.path)) continue;
        std::istringstream lines(file.text);
        for (std::string line; std::getline(lines, line);)
        {
            const std::string operand = operand_of(line);
            const std::size_t end = operand.find('"', 1);
            if (!operand.starts_with('"') || end == std::string::npos) continue;
            const auto path = resolve(file.path, *home, operand.substr(1, end - 1), known);
            if (path && unit_of(*path) != unit_of(file.path)) out[unit_of(file.path)].insert(unit_of(*path));
        }
    }
    return out;
}

/// Depth-first search from every unit not visited yet; an include of a unit that is on the current path closes a circle.
class CircleSearch
{
public:
    explicit CircleSearch(const std::map<std::string, std::set<std::string>>& included) : included_(included) {}
    Complaints run()
    {
        for (const auto& [unit, others] : included_) visit(unit);
        return std::move(found_);
    }

private:
    void visit(const std::string& unit)
    {
        if (!seen_.insert(unit).second) return;
        path_.push_back(unit);
        if (const auto found = included_.find(unit); found != included_.end())
            for (const std::string& other : found->second)
            {
                const auto begin = std::ranges::find(path_, other);
                if (begin == path_.end())
                    visit(other);
                else
                    report_circle(begin);
            }
        path_.pop_back();
    }
    void report_circle(std::vector<std::string>::const_iterator begin)
    {
        std::string text;
        for (auto unit = begin; unit != path_.end(); ++unit) text += *unit + " -> ";
        found_.push_back(text + *begin);
    }

    const std::map<std::string, std::set<std::string>>& included_;
    std::set<std::string> seen_;
    std::vector<std::string> path_;
    Complaints found_;
};

template <class Judge>
Complaints each_line(const File& file, Judge&& judge)
{
    Complaints out;
    int number = 0;
    for (std::size_t begin = 0; begin < file.text.size();)
    {
        const std::size_t end = std::min(file.text.find('\n', begin), file.text.size());
        const std::string what = judge(file.text.substr(begin, end - begin));
        ++number;
        if (!what.empty()) out.push_back(file.path + ":" + std::to_string(number) + ": " + what);
        begin = end + 1;
    }
    return out;
}

bool is_text(const fs::path& path)
{
    static const Paths kinds{".h", ".cpp", ".txt", ".cmake", ".md", ".xml", ".sh", ".json", ".yml", ""};
    return kinds.contains(path.extension().string());
}

File read(const fs::path& path, const fs::path& root)
{
    std::ifstream in(path, std::ios::binary);
    return {path.lexically_relative(root).generic_string(), std::string(std::istreambuf_iterator<char>(in), {})};
}

}  // namespace

std::vector<File> read_tree(const std::string& root)
{
    std::vector<File> files;
    for (const auto& top : fs::directory_iterator(root))
    {
        const std::string name = top.path().filename().string();
        if (name == ".git") continue;  // in a linked worktree it is a file
        if (top.is_regular_file() && is_text(top.path())) files.push_back(read(top.path(), root));
        if (!top.is_directory() || name.starts_with("build")) continue;
        for (const auto& entry : fs::recursive_directory_iterator(top))
            if (entry.is_regular_file() && is_text(entry.path())) files.push_back(read(entry.path(), root));
    }
    std::ranges::sort(files, {}, &File::path);
    return files;
}

Paths paths_of(const std::vector<File>& files)
{
    Paths paths;
    for (const File& file : files) paths.insert(file.path);
    return paths;
}

bool is_source(std::string_view path)
{
    static constexpr std::string_view kPlaces[] = {"server", "interactions", "idl", "clients", "tests"};
    return std::ranges::any_of(kPlaces, [&](std::string_view place) { return inside(path, place); }) &&
           (path.ends_with(".h") || path.ends_with(".cpp"));
}

Complaints check_includes(const File& file, const Paths& known)
{
    const auto home = home_of(file.path);
    if (!home) return {file.path + ":1: stands in no layer of the table"};
    static const std::regex operand(R"(^([<"])([^>"]+)[>"].*$)");
    return each_line(file,
                     [&](const std::string& line) -> std::string
                     {
                         std::smatch match;
                         const std::string rest = operand_of(line);
                         if (rest.empty()) return {};
                         if (!std::regex_match(rest, match, operand)) return "an include that names no file: " + rest;
                         return match[1] == "<" ? judge_system(file, *home, match[2]) : judge_own(file, *home, match[2], known);
                     });
}

Complaints check_circles(const std::vector<File>& files) { return CircleSearch(units_included(files)).run(); }

Complaints check_folder_circles(const std::vector<File>& files)
{
    std::map<std::string, std::set<std::string>> folders;
    for (const auto& [unit, others] : units_included(files))
        for (const std::string& other : others)
            if (folder_of(other) != folder_of(unit)) folders[folder_of(unit)].insert(folder_of(other));
    return CircleSearch(folders).run();
}

Complaints check_table(const std::vector<Layer>& table)
{
    std::map<std::string, std::set<std::string>> may;
    for (const Layer& layer : table)
        for (const std::string_view target : layer.may_include)
            for (const Layer& other : table)
                if (&other != &layer && (other.folder == target || inside(other.folder, target)))
                    may[std::string(layer.folder)].insert(std::string(other.folder));
    return CircleSearch(may).run();
}

Complaints check_own_rows(const Paths& known)
{
    static constexpr std::string_view kPlaces[] = {"server/simulation", "interactions", "clients", "idl"};
    std::set<std::string> out;
    for (const std::string& path : known)
    {
        if (!is_source(path) || std::ranges::none_of(kPlaces, [&](std::string_view place) { return inside(path, place); })) continue;
        const auto home = home_of(path);
        if (!home || home->root != folder_of(path)) out.insert(folder_of(path) + ": has no row of its own in the table");
    }
    return {out.begin(), out.end()};
}

Complaints check_friends(const std::vector<File>& files)
{
    static const std::regex friendship(R"(\bfriend\s+(?:class|struct)\s+(?:\w+::)*(\w+)\s*;)");
    static const std::regex definition(R"(\b(?:class|struct)\s+(?:\w+::)*(\w+)(?:\s+final)?\s*(?:\{|:[^:;]))");
    std::map<std::string, std::set<std::string>> folders_of;
    for (const File& file : files)
        if (is_source(file.path))
            for (std::sregex_iterator at(file.text.begin(), file.text.end(), definition), end; at != end; ++at)
                folders_of[(*at)[1]].insert(folder_of(file.path));
    Complaints out;
    for (const File& file : files)
    {
        if (!is_source(file.path) || inside(file.path, "tests")) continue;
        for (std::sregex_iterator at(file.text.begin(), file.text.end(), friendship), end; at != end; ++at)
            if (!folders_of[(*at)[1]].contains(folder_of(file.path)))
                out.push_back(file.path + ": has a friend of another folder: " + (*at)[1].str());
    }
    return out;
}

Complaints check_length(const File& file, int limit)
{
    const auto lines = std::ranges::count(file.text, '\n');
    if (lines <= limit) return {};
    return {file.path + ":1: " + std::to_string(lines) + " lines, at most " + std::to_string(limit)};
}

Complaints check_leftovers(const File& file)
{
    // In pieces, or this file would complain about itself.
    static const std::regex leftover(
        "TO"
        "DO|FIX"
        "ME|XX"
        "X");
    return each_line(file,
                     [&](const std::string& line) -> std::string
                     {
                         std::smatch match;
                         return std::regex_search(line, match, leftover) ? "unfinished: " + match.str() : "";
                     });
}

Complaints check_machine_paths(const File& file)
{
    static const std::regex place(
        "(^|[^A-Za-z0-9_.}])(/wo"
        "rk/|/ho"
        "me/)");
    return each_line(file,
                     [&](const std::string& line) -> std::string
                     {
                         std::smatch match;
                         return std::regex_search(line, match, place) ? "names a folder of one machine: " + match[2].str() : "";
                     });
}

Complaints check_readmes(const Paths& known)
{
    Complaints out;
    for (const std::string& path : known)
    {
        if (!path.ends_with("/CMakeLists.txt") || !(inside(path, "server") || inside(path, "interactions"))) continue;
        const std::string folder = folder_of(path);
        if (!known.contains(folder + "/README.md")) out.push_back(folder + ": has no README.md");
    }
    return out;
}

}  // namespace plab::architecture
