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
/// Words that are none of the three count as failures: what is not understood is better seen.
Severity severity_of(std::string_view word);

struct Filter
{
    bool events = true, collisions = true;
    std::vector<std::string> kinds = {};    ///< beginnings: "collision.impact", "script."; none: all
    std::vector<std::string> objects = {};  ///< ids of which an entry names one, as component or participant; none: all
    Severity severity = Severity::Info;     ///< collisions are info

    bool wants(const plab_v2_EventInfo& event) const;
    bool wants(const plab_v2_CollisionInfo& collision) const;
};

}  // namespace plab::logger
