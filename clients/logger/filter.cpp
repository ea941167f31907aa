#include "logger/filter.h"

#include <algorithm>
#include <initializer_list>

namespace plab::logger
{
namespace
{

bool begins_with_one(const std::string& kind, const std::vector<std::string>& beginnings)
{
    return beginnings.empty() || std::any_of(beginnings.begin(), beginnings.end(), [&](const auto& b) { return kind.starts_with(b); });
}

bool names_one(std::initializer_list<const char*> ids, const std::vector<std::string>& wanted)
{
    const auto is_wanted = [&](const char* id) { return std::find(wanted.begin(), wanted.end(), id) != wanted.end(); };
    return wanted.empty() || std::any_of(ids.begin(), ids.end(), is_wanted);
}

}  // namespace

Severity severity_of(std::string_view word)
{
    if (word == "info") return Severity::Info;
    return word == "warning" ? Severity::Warning : Severity::Failure;
}

bool Filter::wants(const plab_v2_EventInfo& e) const
{
    return events && severity_of(e.severity) >= severity && begins_with_one(e.kind, kinds) &&
           names_one({e.component_id, e.a, e.b}, objects);
}

bool Filter::wants(const plab_v2_CollisionInfo& c) const
{
    return collisions && severity == Severity::Info && begins_with_one(std::string("collision.") + c.kind, kinds) &&
           names_one({c.detector, c.a, c.b}, objects);
}

}  // namespace plab::logger
