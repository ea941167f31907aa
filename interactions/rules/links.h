/// The pairs that a rule has dealt with: what it made between them, or why not.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plab/ref.h"
#include "plab/value.h"

namespace plab::rules
{

enum class Progress : std::uint8_t
{
    Drawing,  ///< the two are drawn together
    Made,     ///< what the template says stands between them
    Refused,  ///< it could not be made, or somebody has removed it: not tried again before the two have parted
};

struct Link
{
    std::string id;  ///< of what was made, or is to be
    Progress progress = Progress::Made;
    std::string a, b;                                    ///< ids of the connectors, or of the objects themselves
    std::uint32_t site_a = kNoIndex, site_b = kNoIndex;  ///< kNoIndex: it is not there
};

/// The text form in which links are kept as state: "made", and the two ids, separated by tabs, by the id of what was made.
Entries to_entries(const std::vector<Link>& links);
/// Entries that have another form are left out.
std::vector<Link> to_links(const Entries& entries);

}  // namespace plab::rules
