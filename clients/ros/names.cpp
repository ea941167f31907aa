#include "ros/names.h"

#include <string_view>

namespace plab::ros
{

std::string plain_name(const std::string& id)
{
    constexpr std::string_view kInside = "_.-/";
    std::string out;
    for (const char c : id)
    {
        const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        out += is_letter || kInside.find(c) != std::string_view::npos ? c : '_';
    }
    // tf2 refuses a '/' at the beginning.
    if (out.empty() || out.front() == '.' || out.front() == '-' || out.front() == '/') out.insert(out.begin(), '_');
    return out;
}

const std::string& NameTable::name_of(const std::string& id)
{
    const auto known = names_.find(id);
    if (known != names_.end()) return known->second;
    const std::string plain = plain_name(id);
    std::string name = plain;
    for (int n = 2; name == kWorldFrame || ids_.contains(name); ++n) name = plain + "_" + std::to_string(n);
    ids_.emplace(name, id);
    return names_.emplace(id, std::move(name)).first->second;
}

const std::string& NameTable::id_of(const std::string& name) const
{
    static const std::string kNone;
    const auto at = ids_.find(name);
    return at == ids_.end() ? kNone : at->second;
}

void NameTable::keep_only(const std::set<std::string>& ids)
{
    for (auto at = names_.begin(); at != names_.end();)
    {
        if (ids.contains(at->first))
        {
            ++at;
            continue;
        }
        ids_.erase(at->second);
        at = names_.erase(at);
    }
}

}  // namespace plab::ros
