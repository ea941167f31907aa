#include "docs/comment_names.h"

#include <algorithm>
#include <cctype>
#include <regex>
#include <sstream>
#include <utility>

namespace plab::test
{
namespace
{

/// Its strings are names that no code has.
constexpr std::string_view kExceptions = "tests/docs/comments_test.cpp";

bool is_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The place after the string literal that begins at `at`, or the end of the line.
std::size_t end_of_literal(const std::string& line, std::size_t at)
{
    const char quote = line[at];
    for (++at; at < line.size() && line[at] != quote; ++at)
        if (line[at] == '\\') ++at;
    return std::min(at + 1, line.size());
}

/// ")delimiter\"" of a raw string literal that begins at `at`; "" if none does.
std::string end_of_raw_literal(const std::string& line, std::size_t at)
{
    if (line.compare(at, 2, "R\"") != 0 || (at > 0 && is_letter(line[at - 1]))) return {};
    const std::size_t open = line.find('(', at);
    return open == std::string::npos ? std::string() : ")" + line.substr(at + 2, open - at - 2) + "\"";
}

/// Where the comment of a line begins, or its end. `raw`: the end of the raw string literal that the line begins in; on return, the one
/// that it ends in.
std::size_t begin_of_comment(const std::string& line, std::string& raw)
{
    for (std::size_t at = 0; at < line.size();)
    {
        if (!raw.empty())
        {
            const std::size_t end = line.find(raw, at);
            if (end == std::string::npos) return line.size();
            at = end + raw.size(), raw.clear();
        }
        else if (line.compare(at, 2, "//") == 0)
            return at;
        else if (raw = end_of_raw_literal(line, at); !raw.empty())
            at = line.find('(', at) + 1;
        else if (line[at] == '"' || (line[at] == '\'' && (at == 0 || !is_letter(line[at - 1]))))
            at = end_of_literal(line, at);
        else
            ++at;
    }
    return line.size();
}

/// "a::b" and "b()" are "a", "b".
std::vector<std::string> parts_of(const std::string& name)
{
    std::vector<std::string> out;
    std::string part;
    for (const char c : name + ":")
        if (is_letter(c))
            part += c;
        else if (!part.empty())
            out.push_back(std::exchange(part, {}));
    return out;
}

std::string missing_identifier(const std::string& name, const Known& known)
{
    const std::vector<std::string> parts = parts_of(name);
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
        if (!known.words.contains(parts[i])) return "no code has the name " + parts[i];
        const auto type = i > 0 ? known.members.find(parts[i - 1]) : known.members.end();
        if (type != known.members.end() && !type->second.contains(parts[i])) return parts[i - 1] + " has no " + parts[i];
    }
    return {};
}

std::string missing_file(const std::string& name, const Comment& comment, const Known& known)
{
    if (known.included_headers.contains(name)) return {};
    return missing({name, comment.file, comment.line}, known.declared);
}

/// "swaps" and "reference_swaps" of tests/reference/swaps_test.cpp.
void add_names_of_test(const std::string& path, std::set<std::string>& words)
{
    const std::size_t file = path.rfind('/') + 1, folder = path.rfind('/', file - 2) + 1,
                      end = path.size() - std::string_view("_test.cpp").size();
    const std::string name = path.substr(file, end - file);
    words.insert(name), words.insert(path.substr(folder, file - 1 - folder) + "_" + name);
}

/// Calls `check` with each match of `pattern` in the text.
template <class Check>
void each(const std::string& text, const std::regex& pattern, Check check)
{
    for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) check((*at)[1].str());
}

}  // namespace

Source read_source(const std::string& text, const std::string& file)
{
    static const std::regex declaration("\\b(struct|class) (?:alignas\\([^)]*\\) )?([A-Za-z_][A-Za-z0-9_]*)(?! *;)");
    static const std::regex include("^ *# *include *[<\"]([^>\"]+)[>\"]");
    Source out;
    std::istringstream in(text);
    std::string raw;
    int number = 0;
    for (std::string line; std::getline(in, line);)
    {
        ++number;
        const std::size_t comment = begin_of_comment(line, raw);
        if (comment < line.size()) out.comments.push_back({line.substr(comment + 2), file, number});
        line.resize(comment);
        add_words(line, out.words);
        for (std::sregex_iterator at(line.begin(), line.end(), declaration), end; at != end; ++at) out.types.insert((*at)[2]);
        if (std::smatch header; std::regex_search(line, header, include)) out.included_headers.insert(header[1]);
    }
    return out;
}

void add_words(const std::string& text, std::set<std::string>& words)
{
    std::string word;
    for (const char c : text + " ")
        if (is_letter(c))
            word += c;
        else if (!word.empty())
            words.insert(std::exchange(word, {}));
}

std::vector<MissingName> missing_names(const Comment& comment, const Known& known)
{
    // What stands before and after a name; ECMAScript's regular expressions cannot look back.
    static const std::string before = "(?:^|[^A-Za-z0-9_./-])", name = "[A-Za-z_][A-Za-z0-9_]*", after = "(?![A-Za-z0-9_/-]|\\.[A-Za-z])";
    static const std::regex quoted("`([^`]+)`"), identifier(name + "(::~?" + name + ")*(\\(\\))?");
    static const std::regex path(
        "(?:^|[^A-Za-z0-9_./*}-])([A-Za-z0-9_][A-Za-z0-9_./-]*\\.(?:h|cpp|md|xml|idl|cmake|lua|sh|py))(?![A-Za-z0-9_*{])");
    static const std::regex folder(
        before + "((?:server|interactions|clients|idl|scenes|tests|docker)/[a-z0-9_/]*[a-z0-9_])(?![A-Za-z0-9_*{.-]|/[A-Z])");
    static const std::regex type("(?:^|[^A-Za-z0-9_/.])((?:[A-Z][A-Za-z0-9]*/)+[A-Z][A-Za-z0-9]*)");
    static const std::regex call("(" + name + "(?:::~?" + name + ")*\\(\\)|" + name + "(?:::" + name + ")+)");
    static const std::string snake = "[a-z][a-z0-9]{2,}(?:_[a-z][a-z0-9]{2,})+_?", member = "[a-z][a-z0-9]{2,}_",
                             constant = "k[A-Z][A-Za-z0-9]+", camel = "[A-Z][a-z0-9]+(?:[A-Z][a-z0-9]+)+";
    static const std::regex word(before + "(" + snake + "|" + member + "|" + constant + "|" + camel + ")" + after);
    std::vector<MissingName> out;
    const auto add = [&](const std::string& thing, std::string reason)
    {
        if (!reason.empty()) out.push_back({thing, std::move(reason)});
    };
    each(comment.text, quoted,
         [&](const std::string& thing)
         {
             const bool is_code = std::regex_match(thing, identifier);
             const std::string reason = missing({thing, comment.file, comment.line}, known.declared);
             add(thing, is_code && reason.empty() ? missing_identifier(thing, known) : reason);
         });
    const std::string rest = std::regex_replace(comment.text, quoted, "` `");
    each(rest, path, [&](const std::string& file) { add(file, missing_file(file, comment, known)); });
    each(rest, folder, [&](const std::string& id) { add(id, missing({id, comment.file, comment.line}, known.declared)); });
    each(rest, type, [&](const std::string& id) { add(id, missing({id, comment.file, comment.line}, known.declared)); });
    each(rest, call, [&](const std::string& id) { add(id, missing_identifier(id, known)); });
    if (rest.find(" = ") == std::string::npos) each(rest, word, [&](const std::string& id) { add(id, missing_identifier(id, known)); });
    return out;
}

Known known_in(const std::string& root, std::vector<Comment>& comments)
{
    Known out;
    out.declared = declared_in(root);
    for (const std::string& path : out.declared.paths)
    {
        const std::string name = path.substr(path.rfind('/') + 1);
        const auto ends = [&](std::initializer_list<const char*> endings)
        { return std::any_of(endings.begin(), endings.end(), [&](const char* e) { return name.ends_with(e); }); };
        out.words.insert(name.substr(0, name.find('.')));
        if (name.ends_with("_test.cpp")) add_names_of_test(path, out.words);
        if (ends({".h", ".cpp", ".idl", ".c"}))
        {
            Source source = read_source(text_of_file(root + "/" + path), path);
            comments.insert(comments.end(), source.comments.begin(), source.comments.end());
            for (const std::string& type : source.types) out.members[type].insert(source.words.begin(), source.words.end());
            if (path != kExceptions) out.words.merge(source.words);
            out.included_headers.merge(source.included_headers);
        }
        else if (ends({".txt", ".cmake", ".xml", ".lua", ".sh", ".py", ".json", ".in", ".yml", ".yaml"}))
            add_words(text_of_file(root + "/" + path), out.words);
    }
    return out;
}

}  // namespace plab::test
