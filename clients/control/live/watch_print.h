/// How `watch` prints samples: lines for people, or one JSON object per line.
#pragma once

#include <set>

#include "control/command/context.h"
#include "control/live/frames.h"
#include "link/catalogue.h"

namespace plab::cli
{

/// What `watch` omits.
struct Selection
{
    std::set<std::string> ids;  ///< empty: all
    bool takes(const std::string& id) const { return ids.empty() || ids.count(id) != 0; }
};

class WatchPrinter
{
public:
    WatchPrinter(const Console& console, bool json, const Selection& selection) : console_(console), json_(json), selection_(selection) {}

    void frame(const Frame& frame, const link::Catalogue& catalogue);
    void metrics(const link::Metrics& metrics);
    void contacts(wire::ContactForces contacts);
    /// Prints the entry if it is selected; returns whether it was.
    bool collision(const plab_v2_Collisions& sample, std::uint32_t entry);
    bool event(const plab_v2_Events& sample, std::uint32_t entry);
    /// Numbers are missing: reports it at that place.
    void gap(const char* what, std::uint64_t missed, std::uint64_t before);

private:
    const Console& console_;
    bool json_;
    const Selection& selection_;
    bool has_title_ = false;
};

}  // namespace plab::cli
