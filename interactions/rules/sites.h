/// The places at which a rule looks: objects, or connectors on them, that match its patterns.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "plab/context.h"
#include "plab/tables.h"
#include "relation.h"

namespace plab::rules
{

/// Patterns of one side of a rule; an empty one does not count.
struct Wanted
{
    std::string ids, type, shape, connector;
};

struct Site
{
    std::uint32_t component = kNoIndex;  ///< the connector, or the object itself
    Ref object;
    Ref connector;         ///< not valid: the object itself
    Pose offset;           ///< X_BF
    double radius = 0;     ///< m
    double tolerance = 0;  ///< m, of the connector; the larger one of this and of the rule's counts
    bool is_a = false, is_b = false;
};

/// All objects and connectors that match one side or both, in the order of their ids.
std::vector<Site> find_sites(const Lookup& lookup, const Wanted& a, const Wanted& b);

/// X_WF and the radius, now.
Place place_of(const Site& site, const Bodies& bodies, const Shafts& shafts);
Vec3 origin_of(const Site& site, const Bodies& bodies, const Shafts& shafts);
/// Of the frame's origin, in W.
Vec3 velocity_of(const Site& site, const Bodies& bodies, const Shafts& shafts);
Vec3 spin_of(const Site& site, const Bodies& bodies, const Shafts& shafts);
bool is_dynamic(const Site& site, const Bodies& bodies, const Shafts& shafts);

}  // namespace plab::rules
