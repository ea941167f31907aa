#include "model/text.h"

#include <algorithm>

namespace plab::model
{

std::string_view trimmed(std::string_view text)
{
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::vector<std::string_view> split_words(std::string_view text)
{
    std::vector<std::string_view> words;
    std::size_t i = 0;
    while (i < text.size())
    {
        if (is_blank(text[i]))
        {
            ++i;
            continue;
        }
        const std::size_t begin = i;
        while (i < text.size() && !is_blank(text[i])) ++i;
        words.push_back(text.substr(begin, i - begin));
    }
    return words;
}

bool equal_ignoring_case(std::string_view a, std::string_view b)
{
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (to_lower(a[i]) != to_lower(b[i])) return false;
    return true;
}

std::string quoted(std::string_view text)
{
    constexpr std::size_t kMost = 80;
    std::size_t n = std::min(text.size(), kMost);
    // Do not cut within a UTF-8 sequence: continuation bytes are 10xxxxxx.
    while (n < text.size() && n > 0 && (static_cast<unsigned char>(text[n]) & 0xc0) == 0x80) --n;
    std::string shown(text.substr(0, n));
    for (char& c : shown)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return "'" + shown + (n < text.size() ? "..." : "") + "'";
}

std::string quoted_list(const std::vector<std::string>& names, std::string_view last_word, std::size_t most)
{
    std::string out;
    const std::size_t n = std::min(names.size(), most);
    for (std::size_t i = 0; i < n; ++i)
    {
        if (i > 0) out += i + 1 == names.size() ? " " + std::string(last_word) + " " : ", ";
        out += quoted(names[i]);
    }
    if (n < names.size()) out += ", ...";
    return out;
}

std::string place_text(const SourceLocation& where)
{
    std::string out = where.file;
    if (where.line == 0) return out.empty() ? "another place" : out;
    if (!out.empty()) out += ":";
    return out + std::to_string(where.line) + ":" + std::to_string(where.column);
}

}  // namespace plab::model
