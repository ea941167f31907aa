/// plab-bus as plabd sees it: a process that plabd starts, communicates with, and does not trust.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <memory>
#include <string>

#include "bus/channel/messages.h"
#include "bus/channel/pipe.h"
#include "bus/channel/wake_event.h"

namespace plab::bus
{

class BusProcess
{
public:
    static constexpr std::uint64_t kMostUp = (6u << 20);  ///< largest message from plab-bus, in bytes

    /// Starts `program`; it notifies `wake` when it has sent something. Call this on the thread that lives as long as the bus: the
    /// process ends with that thread.
    static Result<std::unique_ptr<BusProcess>> start(const std::string& program, const WakeEvent& wake, const StartMessage& start);
    /// Ends the process if it is still running, and waits for its end.
    ~BusProcess();
    BusProcess(const BusProcess&) = delete;
    BusProcess& operator=(const BusProcess&) = delete;

    MessageWriter& writer() { return writer_; }
    MessageReader& reader() { return reader_; }
    void notify() const { wake_.notify(); }
    pid_t pid() const { return pid_; }
    /// A descriptor that becomes readable, with nothing to read, when the process has ended.
    int lifeline() const { return lifeline_; }
    /// How it ended, in words ("was ended by signal 6 (Aborted)"); empty while it runs.
    std::string ended();
    /// Whether it is stopped (SIGSTOP, a debugger), so that it does nothing until it is continued. As of the last call of
    /// ended().
    bool stopped() const { return is_stopped_; }
    /// Waits for the end of the process; false if it did not end in time, or cannot end.
    bool wait(std::chrono::milliseconds longest);

private:
    BusProcess(PipeMemory memory, WakeEvent wake);

    PipeMemory memory_;
    WakeEvent wake_;  ///< what plab-bus sleeps on
    MessageWriter writer_;
    MessageReader reader_;
    int lifeline_ = -1;
    pid_t pid_ = -1;
    bool is_gone_ = false, is_stopped_ = false;
    int status_ = 0;
};

/// The plab-bus program beside this program, or plab-bus-ros, which is a ROS node as well; PLAB_BUS_PROGRAM, if set, names another one.
std::string bus_program(bool with_ros);

}  // namespace plab::bus
