/// Finds where two runs differ: the first component in the order of ids, the first of its fields, and both values.
#pragma once

#include <optional>
#include <string>

#include "simulation/snapshot/snapshot.h"

namespace plab::simulation
{

struct Difference
{
    std::string component;      ///< id; "pair A B" for contacts, empty for what belongs to no component (the clock)
    std::string field;          ///< of its type, of its host row ("angular_momentum"), or of a contact
    std::string first, second;  ///< values as text that parses back to the same bits; "-" where one side has none

    std::string text() const;
};

struct Comparison
{
    bool params = true, outputs = false;  ///< compared in addition to the state, which is always compared
    bool ledger = false;                  ///< energy ledger and memory of events; the last digits depend on the number of threads
    std::size_t most = 1;                 ///< stop after this many differences
};

/// Bitwise comparison: 0 and -0 differ, a NaN equals itself. Components come in id order, then contacts, then the clock.
std::vector<Difference> differences(const SnapshotContent& first, const SnapshotContent& second, const Comparison& how = {});

/// The first difference, if any.
inline std::optional<Difference> compare(const Snapshot& first, const Snapshot& second, const Comparison& how = {})
{
    const auto all = differences(*first, *second, how);
    return all.empty() ? std::nullopt : std::optional(all.front());
}

/// Compares the state only, without the clock.
std::optional<Difference> compare_worlds(const world::Image& first, const ContactsImage& first_contacts, const world::Image& second,
                                         const ContactsImage& second_contacts);

}  // namespace plab::simulation
