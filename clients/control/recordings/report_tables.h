/// The tables of a report. Empty ones are left out.
#pragma once

#include "control/recordings/segments.h"
#include "control/recordings/summary.h"
#include "figures/page.h"

namespace plab::recordings
{

void add_segments(figures::Page& page, const std::vector<Segment>& segments);
void add_requests(figures::Page& page, const Log& log);
void add_events(figures::Page& page, const Log& log, const Summary& summary);
void add_runs(figures::Page& page, const Summary& summary);
void add_losses(figures::Page& page, const Summary& summary);
void add_topics(figures::Page& page, const Summary& summary);

/// "At 1 s contact.response was exchanged, Response/Impulse → Response/None: 2 µs per step before, 0.1 µs after."
std::string sentence_of(const Swap& swap, const std::vector<Segment>& segments);

}  // namespace plab::recordings
