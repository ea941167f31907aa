/// A component type in words, for listings, manifests and the bus. Plain text, so that it is available without loading the
/// plugin.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/type_registry.h"

namespace plab::model
{

struct FieldSummary
{
    std::string name, kind, value_type, unit, fallback, rule, doc;
    bool required = false;
    friend bool operator==(const FieldSummary&, const FieldSummary&) = default;
};
struct RoleSummary
{
    std::string name, accepts, doc;
    std::uint32_t least = 0, most = 0;  ///< most: 4294967295 for any number
    friend bool operator==(const RoleSummary&, const RoleSummary&) = default;
};
struct TypeSummary
{
    std::string name, family, doc, plugin;
    bool loaded = false;
    int order = 0;
    std::string accuracy, strengths, cost, limits, source;
    std::vector<RoleSummary> roles;
    std::vector<FieldSummary> fields;
    friend bool operator==(const TypeSummary&, const TypeSummary&) = default;
};

/// `loaded` is true in what this returns. Scratch fields are left out.
TypeSummary summary_of(const ComponentType& type);

// The texts that it uses, also for the reference manual and listings.
std::string_view name_of(FieldKind kind);
std::string_view name_of(FieldType type);
/// "positive, at most 1"; empty if there are no rules.
std::string rules_in_words(const Field& field);
/// The kinds of components that fit a role: "body or shaft".
std::string facets_in_words(const Role& role);

}  // namespace plab::model
