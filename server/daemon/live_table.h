/// The live table of --table.
#pragma once

#include <chrono>
#include <deque>
#include <mutex>
#include <string>

#include "publish/busy.h"
#include "simulation/simulation.h"

namespace plab::daemon
{

/// Redraws in place on a terminal; otherwise prints a block each simulated second. The last events are below it.
class LiveTable
{
public:
    /// On a terminal, `footer` is below the table.
    LiveTable(bool wanted, std::string footer);
    void note(const simulation::Simulation& simulation);
    void note(std::string line);
    void show(const simulation::Simulation& simulation, bool last = false);
    /// Called from another thread during a step that takes long: shows its activity.
    void show_busy(const publish::Busy& busy);

private:
    static void keep(std::deque<std::string>& lines, std::size_t most, std::string line);

    std::mutex output_;  ///< only one thread writes at a time
    bool wanted_, terminal_;
    std::string footer_;
    std::chrono::steady_clock::time_point shown_{};
    std::chrono::steady_clock::time_point busy_shown_{};
    double next_ = 0;
    Tick shown_tick_ = -1;
    std::deque<std::string> lines_, changes_;  ///< latest events; on a terminal, latest changes of level
    std::string levels_;                       ///< shown until the time below, or another run
    std::chrono::steady_clock::time_point levels_until_{};
    std::uint64_t levels_of_run_ = 0;
};

/// "contact.impact contact (red, green): message".
std::string event_text(const simulation::Simulation& simulation, const Event& event);

}  // namespace plab::daemon
