#include "model/names.h"

#include <algorithm>

#include "model/text.h"

namespace plab::model
{

std::string field_name_of_setter(std::string_view setter)
{
    if (setter.size() > 3 && setter.starts_with("Set") && !is_lower(setter[3])) setter.remove_prefix(3);
    std::string out;
    for (std::size_t i = 0; i < setter.size(); ++i)
    {
        // A word begins at a capital after a small letter, and at the last capital of a run ("URLName": url_name).
        const bool after_small = i > 0 && is_upper(setter[i]) && (is_lower(setter[i - 1]) || is_digit(setter[i - 1]));
        const bool ends_run = i > 0 && i + 1 < setter.size() && is_upper(setter[i - 1]) && is_upper(setter[i]) && is_lower(setter[i + 1]);
        if (after_small || ends_run) out += '_';
        out += to_lower(setter[i]);
    }
    return out;
}

std::string setter_of_field_name(std::string_view field)
{
    std::string out = "Set";
    bool begins = true;
    for (const char c : field)
    {
        if (c == '_')
        {
            begins = true;
            continue;
        }
        out += begins && is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c;
        begins = false;
    }
    return out;
}

bool is_pattern(std::string_view id) { return id.find_first_of("*?") != std::string::npos; }

bool matches(std::string_view pattern, std::string_view id)
{
    // Greedy, backtracking only to the last star, which takes linear time in practice.
    std::size_t p = 0, t = 0, star = std::string_view::npos, from = 0;
    while (t < id.size())
    {
        if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == id[t]) && pattern[p] != '*')
            ++p, ++t;
        else if (p < pattern.size() && pattern[p] == '*')
            star = p++, from = t;
        else if (star != std::string_view::npos)
            p = star + 1, t = ++from;
        else
            return false;
    }
    while (p < pattern.size() && pattern[p] == '*') ++p;
    return p == pattern.size();
}

bool takes_part(const std::vector<std::string>& patterns, std::string_view id)
{
    return patterns.empty() || std::any_of(patterns.begin(), patterns.end(), [&](const std::string& p) { return matches(p, id); });
}

}  // namespace plab::model
