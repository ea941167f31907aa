/// One look of a rule at its pairs.
#pragma once

#include <optional>
#include <set>
#include <string>

#include "loops.h"
#include "rule.h"

namespace plab::rules
{

/// The tables that a look reads, and where it asks.
struct Scene
{
    const StepContext& context;
    const Bodies& bodies;
    const Shafts& shafts;
    const Quantities& quantities;
};

class Round
{
public:
    Round(const Scene& scene, Row row, RuleRows& rules, RequestSink& requests);
    void run();

private:
    struct Pair
    {
        std::uint32_t a, b;  ///< sites
        Measures measures;
        Entries values;  ///< for the template
    };

    Memory& memory_of(Row row) const;
    Measures measures_of(const Memory& memory, std::uint32_t a, std::uint32_t b) const;
    /// Whether a rule, this or another one, has the pair in mind: bounds and Lua.
    bool applies(Row row, Pair& pair) const;
    /// Another rule of the slot that has the two objects, or takes precedence.
    bool yields(const Pair& pair) const;
    bool precedes(Row other) const;
    bool is_full(Row row, const Pair& pair) const;
    Bounds bounds_for(Row row, const Site& a, const Site& b) const;

    void look_after_links();
    bool look_after(Link& link);
    void latch(Link& link);
    bool is_latched(const Link& link) const;
    void meet();
    void make(Pair pair);
    std::optional<Value> known(Row row, const Pair& pair, std::string_view name) const;
    std::optional<Value> known_of(const Site& site, std::string_view name) const;
    Result<std::string> blueprint_for(const Pair& pair) const;
    std::string drawing_for(const Pair& pair, const std::string& id) const;
    std::string words(const Pair& pair) const;
    /// Why the pair cannot be coupled as the rule says; empty: it can, and counts as coupled from now on.
    std::string couple(const Pair& pair, const std::string& id);
    /// What rules of this type have coupled.
    Couplings find_couplings() const;

    const Scene& scene_;
    const Lookup& lookup_;
    Row row_;
    RuleRows& rules_;
    RequestSink& requests_;
    Memory& memory_;
    Bounds bounds_;
    bool changed_ = false;
    std::optional<Couplings> couplings_;  ///< once they are needed
    std::set<std::string> ids_;           ///< of the links, once they are needed
};

}  // namespace plab::rules
