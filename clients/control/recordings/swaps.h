/// Exchanges of algorithms: from the journal, or from the catalogue if no journal was recorded.
#pragma once

#include "control/recordings/things.h"

namespace plab::recordings
{

struct Swap
{
    std::uint64_t run = 0;
    std::int64_t step = 0;       ///< took effect before this one
    std::optional<double> time;  ///< s, simulated; unknown if it comes from the catalogue
    std::uint64_t log_time = 0;
    std::string component;
    std::string from;  ///< "" if the recording does not contain it
    std::string to;
    std::string origin;  ///< "client", "command line"; "" if there is no journal
};

class Swaps
{
public:
    /// Of the journal's entries.
    void note(const Entry& entry);
    /// Adds what the catalogue knows: the former algorithms; without a journal, its changes.
    std::vector<Swap> all(const Things& things) const;

private:
    std::vector<Swap> swaps_;
    bool has_journal_ = false;
};

}  // namespace plab::recordings
