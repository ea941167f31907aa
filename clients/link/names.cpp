#include "link/names.h"

#include <algorithm>
#include <cctype>

namespace plab::link
{
namespace
{

// Names are short; a larger distance is not a typing error, and computing it costs the product of the lengths.
constexpr std::size_t kLongestCompared = 128;
constexpr std::size_t kFar = 1000;

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

/// Insertions, deletions, replacements and swaps of neighbours that turn a into b, ignoring case.
std::size_t edit_distance(std::string_view a, std::string_view b)
{
    std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
    {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j)
        {
            const bool same = lower(a[i - 1]) == lower(b[j - 1]);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0u : 1u)});
            const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
        std::swap(before_last, last), std::swap(last, row);
    }
    return last[b.size()];
}

std::string_view last_part(std::string_view name)
{
    const std::size_t at = name.find_last_of("/.");
    return at == std::string_view::npos ? name : name.substr(at + 1);
}

/// Distance from `known` to `wanted`; kFar if it is not a suggestion. The last parts alone may match: "Bisection" means
/// "Resolution/Bisection".
std::size_t score(std::string_view wanted, std::string_view known)
{
    if (known.size() > kLongestCompared) return kFar;
    const auto allowed = [](std::string_view word) { return word.size() < 2 ? 0 : std::max<std::size_t>(1, word.size() / 3); };
    const std::size_t whole = edit_distance(wanted, known);
    if (whole <= allowed(wanted)) return whole;
    const std::string_view a = last_part(wanted), b = last_part(known);
    if (a.empty() || (a.size() == wanted.size() && b.size() == known.size())) return kFar;
    const std::size_t part = edit_distance(a, b);
    return part <= a.size() / 4 ? part + 1 : kFar;
}

}  // namespace

std::vector<std::string> nearest_names(std::string_view wanted, const std::vector<std::string>& known, std::size_t most)
{
    if (wanted.empty() || wanted.size() > kLongestCompared) return {};
    std::vector<std::pair<std::size_t, std::string>> found;
    for (const std::string& name : known)
        if (const std::size_t s = score(wanted, name); s < kFar) found.emplace_back(s, name);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    std::vector<std::string> out;
    for (std::size_t i = 0; i < std::min(most, found.size()); ++i) out.push_back(std::move(found[i].second));
    return out;
}

std::string did_you_mean(std::string_view wanted, const std::vector<std::string>& known)
{
    const std::vector<std::string> near = nearest_names(wanted, known);
    std::string out;
    for (std::size_t i = 0; i < near.size(); ++i) out += (i == 0 ? ", did you mean '" : i + 1 == near.size() ? "' or '" : "', '") + near[i];
    return out.empty() ? out : out + "'?";
}

}  // namespace plab::link
