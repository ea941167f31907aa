/// Names that a person types: suggestions for misspelled ones, and the id at the beginning of a longer one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plab
{
namespace detail
{

constexpr char lower_case(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Longer names are unlikely to be typing errors, and comparing them costs the product of their lengths.
inline constexpr std::size_t kLongestCompared = 120;

/// Optimal string alignment distance (insert, delete, replace, swap neighbours), ignoring case; stops counting at `most` + 1.
/// Source: Boytsov, "Indexing methods for approximate dictionary searching", ACM JEA 16 (2011), section 2.
inline std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t most)
{
    const std::size_t n = a.size(), m = b.size();
    if ((n > m ? n - m : m - n) > most) return most + 1;
    std::vector<std::size_t> before(m + 1), last(m + 1), row(m + 1);
    for (std::size_t j = 0; j <= m; ++j) last[j] = j;
    for (std::size_t i = 1; i <= n; ++i)
    {
        row[0] = i;
        std::size_t least = i;
        for (std::size_t j = 1; j <= m; ++j)
        {
            const char x = lower_case(a[i - 1]), y = lower_case(b[j - 1]);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (x == y ? 0u : 1u)});
            const bool swapped = i > 1 && j > 1 && x == lower_case(b[j - 2]) && lower_case(a[i - 2]) == y;
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
            least = std::min(least, row[j]);
        }
        if (least > most) return most + 1;
        std::swap(before, last);
        std::swap(last, row);
    }
    return last[m];
}

inline std::string_view last_part(std::string_view name)
{
    const std::size_t at = name.find_last_of("/.");
    return at == std::string_view::npos ? name : name.substr(at + 1);
}

inline constexpr std::size_t kFar = 1000;

/// Whether one of the names is a piece of the other ("Hull" of "ConvexHull"), ignoring case; less than four letters say too little.
inline bool is_piece(std::string_view a, std::string_view b)
{
    const std::string_view piece = a.size() < b.size() ? a : b, whole = a.size() < b.size() ? b : a;
    const auto same = [](char x, char y) { return lower_case(x) == lower_case(y); };
    return piece.size() >= 4 && std::search(whole.begin(), whole.end(), piece.begin(), piece.end(), same) != whole.end();
}

/// Distance from `known` to `wanted`; kFar if it is not a suggestion. A match of the last parts alone counts as one edit, a last part
/// that is a piece of the other as two.
inline std::size_t score(std::string_view wanted, std::string_view known)
{
    if (known.size() > kLongestCompared) return kFar;
    const std::size_t most = wanted.size() < 2 ? 0 : std::max<std::size_t>(1, wanted.size() / 3);
    std::size_t best = edit_distance(wanted, known, most);
    if (best > most) best = kFar;
    const std::string_view a = last_part(wanted), b = last_part(known);
    const bool has_parts = a.size() != wanted.size() || b.size() != known.size();
    if (!has_parts || a.empty()) return best;
    const std::size_t most_of_part = a.size() / 4;
    const std::size_t d = edit_distance(a, b, most_of_part);
    if (d <= most_of_part) return std::min(best, d + 1);
    return is_piece(a, b) ? std::min<std::size_t>(best, 2) : best;
}

}  // namespace detail

/// Up to `most` names similar to `wanted` (edit distance, case and last part considered), most similar first.
inline std::vector<std::string> nearest_names(std::string_view wanted, const std::vector<std::string>& known, std::size_t most = 3)
{
    if (wanted.empty() || wanted.size() > detail::kLongestCompared) return {};
    std::vector<std::pair<std::size_t, const std::string*>> found;
    for (const std::string& name : known)
        if (const std::size_t s = detail::score(wanted, name); s < detail::kFar) found.emplace_back(s, &name);
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.first != b.first ? a.first < b.first : *a.second < *b.second; });
    std::vector<std::string> out;
    for (const auto& [s, name] : found)
        if (out.size() < most && (out.empty() || out.back() != *name)) out.push_back(*name);
    return out;
}

/// ", did you mean 'a' or 'b'?", or an empty text if no name is similar.
inline std::string did_you_mean(std::string_view wanted, const std::vector<std::string>& known)
{
    const std::vector<std::string> near = nearest_names(wanted, known);
    std::string out;
    for (std::size_t i = 0; i < near.size(); ++i) out += (i == 0 ? ", did you mean '" : i + 1 == near.size() ? "' or '" : "', '") + near[i];
    return out.empty() ? out : out + "'?";
}

/// "ball.position.z" as the id "ball" and "position.z". Ids may contain dots: the longest beginning that `is_id` knows is the id. An
/// empty id: there is none.
struct IdAndRest
{
    std::string id, rest;
};
template <class IsId>
IdAndRest split_id(const std::string& text, IsId&& is_id)
{
    for (std::size_t dot = text.rfind('.'); dot != std::string::npos && dot > 0; dot = text.rfind('.', dot - 1))
        if (std::string id = text.substr(0, dot); is_id(id)) return {std::move(id), text.substr(dot + 1)};
    return {"", text};
}

}  // namespace plab
