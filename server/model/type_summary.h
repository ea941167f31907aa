/// A component type in words: what listings, manifests and the bus say of it. Plain text, so that it can be known
/// without loading the plugin.
#pragma once

#include <string>
#include <vector>

#include "model/type_registry.h"

namespace plab::model
{

struct FieldSummary
{
    std::string name, kind, value_type, unit, fallback, rule, doc;
    bool required = false;
};
struct RoleSummary
{
    std::string name, accepts, doc;
    std::uint32_t least = 0, most = 0;  ///< most: 4294967295 for any number
};
struct TypeSummary
{
    std::string name, family, doc, plugin;
    bool loaded = false;
    int order = 0;
    std::string cost, limits, source;
    std::vector<RoleSummary> roles;
    std::vector<FieldSummary> fields;
};

/// `loaded` is true in what this returns.
TypeSummary summary_of(const ComponentType& type);

}  // namespace plab::model
