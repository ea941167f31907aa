#include "model/names.h"

#include <algorithm>
#include <utility>

#include "model/text.h"

namespace plab::model
{

namespace
{

/// Longer names are unlikely to be typing errors, and comparing them costs the product of their lengths.
constexpr std::size_t kLongestCompared = 120;

/// Optimal string alignment distance (insert, delete, replace, swap neighbours), ignoring case; stops counting at `most` + 1.
/// Source: Boytsov, "Indexing methods for approximate dictionary searching", ACM JEA 16 (2011), section 2.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t most)
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
            const char x = to_lower(a[i - 1]), y = to_lower(b[j - 1]);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (x == y ? 0u : 1u)});
            const bool swapped = i > 1 && j > 1 && x == to_lower(b[j - 2]) && to_lower(a[i - 2]) == y;
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
            least = std::min(least, row[j]);
        }
        if (least > most) return most + 1;
        std::swap(before, last);
        std::swap(last, row);
    }
    return last[m];
}

std::string_view last_part(std::string_view name)
{
    const std::size_t at = name.find_last_of("/.");
    return at == std::string_view::npos ? name : name.substr(at + 1);
}

constexpr std::size_t kFar = 1000;

/// Distance from `known` to `wanted`; kFar if it is not a suggestion. A match of the last parts alone counts as one edit.
std::size_t score(std::string_view wanted, std::string_view known)
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
    return d <= most_of_part ? std::min(best, d + 1) : best;
}

}  // namespace

std::vector<std::string> nearest_names(std::string_view wanted, const std::vector<std::string>& known, std::size_t most)
{
    if (wanted.empty() || wanted.size() > kLongestCompared) return {};
    std::vector<std::pair<std::size_t, const std::string*>> found;
    for (const std::string& name : known)
        if (const std::size_t s = score(wanted, name); s < kFar) found.emplace_back(s, &name);
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.first != b.first ? a.first < b.first : *a.second < *b.second; });
    std::vector<std::string> out;
    for (const auto& [s, name] : found)
        if (out.size() < most && (out.empty() || out.back() != *name)) out.push_back(*name);
    return out;
}

std::string did_you_mean(std::string_view wanted, const std::vector<std::string>& known)
{
    const std::vector<std::string> near = nearest_names(wanted, known);
    return near.empty() ? std::string() : ", did you mean " + quoted_list(near, "or") + "?";
}

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

}  // namespace plab::model
