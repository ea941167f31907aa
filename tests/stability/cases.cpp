#include "case.h"

namespace plab::stability
{

std::vector<Case> all_cases()
{
    std::vector<Case> out;
    for (const auto& make :
         {mass_cases, joint_cases, spring_cases, extent_cases, speed_cases, inertia_cases, contact_cases, script_cases, long_cases})
        for (Case& c : make()) out.push_back(std::move(c));
    return out;
}

}  // namespace plab::stability
