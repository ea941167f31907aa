/// The tables of a report, and what they are made of.
#pragma once

#include "control/recording/analysis/log.h"
#include "control/recording/analysis/summary.h"
#include "figures/page.h"

namespace plab::analysis
{

/// An interaction under one algorithm: its cost and error while that was active.
struct Segment
{
    std::string component;
    std::string algorithm;  ///< that was requested
    std::string resolved;   ///< the algorithm that did the work, as last reported
    std::uint64_t run = 0;
    double begin = 0, end = 0;  ///< s, on the recording's time line, of the first and the last sample
    std::uint64_t samples = 0;
    double mean_cost = 0;  ///< ns per step
    double largest_error = 0;
    std::string error_unit;  ///< unit of the error; errors measured in another unit before are left out
    double work = 0;         ///< J, done in this time
};

/// By component, then time.
std::vector<Segment> segments_of(const Log& log);

// The tables. Empty ones are left out.
void add_segments(figures::Page& page, const std::vector<Segment>& segments);
/// What governors exchanged for what, how often, and what both levels cost and err, as the events `level.changed` tell it.
void add_level_changes(figures::Page& page, const Log& log);
void add_requests(figures::Page& page, const Log& log);
void add_events(figures::Page& page, const Log& log, const Summary& summary);
void add_runs(figures::Page& page, const Summary& summary);
void add_losses(figures::Page& page, const Summary& summary);
void add_topics(figures::Page& page, const Summary& summary);

/// "At 1 s contact.response was exchanged, Response/Impulse → Response/None: 2 µs per step before, 0.1 µs after."
std::string sentence_of(const Swap& swap, const std::vector<Segment>& segments);

}  // namespace plab::analysis
