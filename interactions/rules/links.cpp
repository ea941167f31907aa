#include "links.h"

#include <algorithm>
#include <string_view>

namespace plab::rules
{
namespace
{

constexpr std::string_view kWords[] = {"drawing", "made", "refused"};

}  // namespace

Entries to_entries(const std::vector<Link>& links)
{
    Entries out;
    out.reserve(links.size());
    for (const Link& link : links)
        out.push_back({link.id, std::string(kWords[static_cast<int>(link.progress)]) + "\t" + link.a + "\t" + link.b});
    return out;
}

std::vector<Link> to_links(const Entries& entries)
{
    std::vector<Link> out;
    for (const Entry& entry : entries)
    {
        const auto* text = std::get_if<std::string>(&entry.value);
        const std::size_t first = text ? text->find('\t') : std::string::npos;
        const std::size_t second = first == std::string::npos ? first : text->find('\t', first + 1);
        if (second == std::string::npos) continue;
        const auto word = std::find(std::begin(kWords), std::end(kWords), std::string_view(*text).substr(0, first));
        if (word == std::end(kWords)) continue;
        Link& link = out.emplace_back();
        link.id = entry.name, link.progress = static_cast<Progress>(word - std::begin(kWords));
        link.a = text->substr(first + 1, second - first - 1), link.b = text->substr(second + 1);
    }
    return out;
}

}  // namespace plab::rules
