/// Which entries become lines.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "idl/plab.h"

namespace plab::logger
{

enum class Severity : std::uint8_t
{
    Info,
    Warning,
    Failure,
};
/// Unknown words count as failures: it is safer to show them.
Severity severity_of(std::string_view word);

struct Filter
{
    bool events = true, collisions = true;
    std::vector<std::string> kinds = {};    ///< prefixes: "collision.impact", "script."; empty: all
    std::vector<std::string> objects = {};  ///< ids, one of which an entry must name as component or participant; empty: all
    Severity severity = Severity::Info;     ///< collisions are info

    bool wants(const plab_v2_EventInfo& event) const;
    bool wants(const plab_v2_CollisionInfo& collision) const;
};

}  // namespace plab::logger
