#include "docs/named_things.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string_view>

namespace plab::test
{
namespace
{

namespace fs = std::filesystem;

constexpr std::string_view kStages[] = {"Stage/Init", "Stage/PreStep", "Stage/Step", "Stage/PostStep", "Stage/Rewind", "Stage/Deinit"};
constexpr std::string_view kExtensions[] = {".h",   ".cpp", ".c",  ".md",  ".xml",  ".cmake", ".idl",
                                            ".lua", ".sh",  ".py", ".txt", ".yaml", ".json"};

/// With blanks in place of line breaks, and none at the ends.
std::string on_one_line(const std::string& text)
{
    std::istringstream in(text);
    std::string out;
    for (std::string word; in >> word;) out += (out.empty() ? "" : " ") + word;
    return out;
}

/// "a/{b,c}" is "a/b" and "a/c".
std::vector<std::string> without_braces(const std::string& text)
{
    const std::size_t open = text.find('{'), close = text.find('}', open == std::string::npos ? 0 : open);
    if (open == std::string::npos || close == std::string::npos) return {text};
    std::vector<std::string> out;
    std::istringstream in(text.substr(open + 1, close - open - 1));
    for (std::string choice; std::getline(in, choice, ',');)
        for (const std::string& whole : without_braces(text.substr(0, open) + choice + text.substr(close + 1))) out.push_back(whole);
    return out;
}

/// An asterisk is any text within one folder.
bool fits(std::string_view pattern, std::string_view text)
{
    if (pattern.empty()) return text.empty();
    if (pattern.front() != '*') return !text.empty() && text.front() == pattern.front() && fits(pattern.substr(1), text.substr(1));
    if (fits(pattern.substr(1), text)) return true;
    return !text.empty() && text.front() != '/' && fits(pattern, text.substr(1));
}

std::string first_part(const std::string& path) { return path.substr(0, path.find('/')); }

/// A file or folder by its path from the root or from the document's folder. If it does not begin with a folder of the root, by the
/// end of its path as well: `step/step_tree.h`.
bool has_path(const Declared& declared, const std::string& document, const std::string& name)
{
    const std::size_t slash = document.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : document.substr(0, slash + 1);
    const bool from_root = name.find('/') != std::string::npos && declared.root_folders.contains(first_part(name));
    return std::any_of(declared.paths.begin(), declared.paths.end(),
                       [&](const std::string& path)
                       {
                           std::string_view rest = path;
                           if (rest.ends_with('/') && !name.ends_with('/')) rest.remove_suffix(1);
                           if (fits(name, rest) || fits(folder + name, rest)) return true;
                           if (from_root) return false;
                           for (std::size_t at = rest.find('/'); at != std::string_view::npos; at = rest.find('/', at + 1))
                               if (fits(name, rest.substr(at + 1))) return true;
                           return false;
                       });
}

/// Not `N m`, `Response/None` (a type), `FILE.part` (a placeholder), `build/bin/plabd` (a product), `.../Prepare`.
bool is_path(const std::string& text, const Declared& declared)
{
    static const std::regex letters("[A-Za-z0-9_.+{},*/-]+"), placeholder("(^|[/_.{,])(?!README)[A-Z]+([/_.},]|$)");
    if (!std::regex_match(text, letters) || std::regex_search(text, placeholder)) return false;
    if (text.starts_with("build/") || std::string_view("/.-*").find(text.front()) != std::string_view::npos) return false;
    const bool has_folder = text.find('/') != std::string::npos;
    if (has_folder && text.front() >= 'A' && text.front() <= 'Z') return false;
    if (text.ends_with('/') || (has_folder && declared.root_folders.contains(first_part(text)))) return true;
    return std::any_of(std::begin(kExtensions), std::end(kExtensions), [&](std::string_view e) { return text.ends_with(e); });
}

std::string missing_type(const std::string& name, const Declared& declared)
{
    const std::string kind = first_part(name);
    if (kind == "Stage")
        return std::find(std::begin(kStages), std::end(kStages), name) == std::end(kStages) ? "no stage is called " + name : "";
    if (!declared.type_kinds.contains(kind)) return {};
    const bool is_there = name.ends_with('/') ? declared.reference.find(name) != std::string::npos : has_word(declared.reference, name);
    return is_there ? "" : "no type, family or command is called " + name;
}

/// `reference_swaps_long` is tests/reference/swaps_long_test.cpp, or is named in a CMakeLists.txt.
std::string missing_test(const std::string& name, const Declared& declared)
{
    if (has_word(declared.builds, name)) return {};
    const bool has_source = std::any_of(declared.paths.begin(), declared.paths.end(),
                                        [&](const std::string& path)
                                        {
                                            constexpr std::string_view kEnd = "_test.cpp";
                                            if (!path.ends_with(kEnd)) return false;
                                            const std::string file = path.substr(path.rfind('/') + 1);
                                            return name.ends_with("_" + file.substr(0, file.size() - kEnd.size()));
                                        });
    return has_source ? "" : "no test is called " + name;
}

}  // namespace

std::string text_of_file(const std::string& path)
{
    std::ifstream in(path);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

std::vector<NamedThing> named_things(const std::string& text, const std::string& document)
{
    std::vector<NamedThing> out;
    std::istringstream in(text);
    bool in_block = false, in_name = false;
    int number = 0;
    for (std::string line; std::getline(in, line);)
    {
        ++number;
        const std::size_t begin = line.find_first_not_of(" \t");
        const bool is_fence = begin != std::string::npos && line.compare(begin, 3, "```") == 0;
        if (is_fence) in_block = !in_block;
        if (is_fence || in_block || begin == std::string::npos)
        {
            if (in_name) out.pop_back(), in_name = false;  // a backtick without a second one
            continue;
        }
        for (const char c : line)
        {
            if (c == '`' && !in_name) out.push_back({"", document, number});
            if (c == '`') in_name = !in_name;
            if (c != '`' && in_name) out.back().text += c;
        }
        if (in_name) out.back().text += ' ';
    }
    if (in_name) out.pop_back();
    for (NamedThing& thing : out) thing.text = on_one_line(thing.text);
    return out;
}

Declared declared_in(const std::string& root)
{
    Declared out;
    for (auto at = fs::recursive_directory_iterator(root); at != fs::recursive_directory_iterator(); ++at)
    {
        const std::string path = at->path().lexically_relative(root).generic_string(), name = at->path().filename().string();
        const bool is_left_out = at->is_directory() && (name.starts_with('.') || (at.depth() == 0 && name.starts_with("build")));
        if (is_left_out)
        {
            at.disable_recursion_pending();
            continue;
        }
        out.paths.insert(at->is_directory() ? path + "/" : path);
        if (name == "CMakeLists.txt") out.builds += text_of_file(at->path().string());
    }
    out.reference = text_of_file(root + "/server/docs/reference.md");
    complete(out);
    return out;
}

void complete(Declared& declared)
{
    for (const std::string& path : declared.paths)
        if (path.ends_with('/') && std::count(path.begin(), path.end(), '/') == 1) declared.root_folders.insert(first_part(path));
    std::istringstream in(declared.reference);
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("## ")) declared.type_kinds.insert(line.substr(3));
}

std::string missing(const NamedThing& thing, const Declared& declared)
{
    static const std::regex type("[A-Z][A-Za-z]*/[A-Za-z0-9/{},]*"),
        test("(unit|reference|simulation|golden|daemon|docs|bus|study|conformance)_[a-z0-9_]+");
    if (thing.text.empty()) return {};
    const bool path = is_path(thing.text, declared);
    if (!path && std::regex_match(thing.text, test)) return missing_test(thing.text, declared);
    if (!path && !std::regex_match(thing.text, type)) return {};
    for (const std::string& name : without_braces(thing.text))
    {
        if (!path)
        {
            const std::string reason = missing_type(name, declared);
            if (!reason.empty()) return reason;
        }
        else if (!has_path(declared, thing.document, name))
            return "no file or folder is called " + name;
    }
    return {};
}

std::vector<std::string> options_in(const std::string& text)
{
    static const std::regex begins("(--|(plabctl|plabd|plab-log|plab-view|plab-web|plab-foxglove|plab-study|plab-hello) ).*");
    static const std::regex option("(^|[ \\[|,])(--[a-z][a-z0-9-]*)");
    std::vector<std::string> out;
    if (!std::regex_match(text, begins)) return out;
    for (std::sregex_iterator at(text.begin(), text.end(), option), end; at != end; ++at) out.push_back((*at)[2]);
    return out;
}

std::string plabctl_command_in(const std::string& text)
{
    static const std::regex command("plabctl ([a-z]+)( .*)?");
    std::smatch match;
    return std::regex_match(text, match, command) ? match[1].str() : "";
}

bool has_word(const std::string& text, const std::string& word)
{
    const auto goes_on = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '/'; };
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        if (at + word.size() == text.size() || !goes_on(text[at + word.size()])) return true;
    return false;
}

}  // namespace plab::test
