/// plab-bus as plabd sees it: a process that it starts, speaks with, and does not trust.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <memory>
#include <string>

#include "bus/channel/bell.h"
#include "bus/channel/messages.h"
#include "bus/channel/pipe.h"

namespace plab::bus
{

class BusProcess
{
public:
    static constexpr std::uint64_t kMostUp = (6u << 20);  ///< bytes of a message from plab-bus

    /// Starts `program`; it rings `bell` when it has something to say. On the thread that lives for as long as the bus: the
    /// process ends with it.
    static Result<std::unique_ptr<BusProcess>> start(const std::string& program, const Bell& bell, const StartMessage& start);
    /// Ends it if it has not ended, and waits for that.
    ~BusProcess();
    BusProcess(const BusProcess&) = delete;
    BusProcess& operator=(const BusProcess&) = delete;

    MessageWriter& writer() { return writer_; }
    MessageReader& reader() { return reader_; }
    void ring() const { bell_.ring(); }
    pid_t pid() const { return pid_; }
    /// Readable, with nothing to read, when the process has ended.
    int lifeline() const { return lifeline_; }
    /// How it ended, in words ("was ended by signal 6 (Aborted)"); empty: it has not.
    std::string ended();
    /// It was stopped (SIGSTOP, a debugger's quarrel) and does nothing until somebody lets it go on. As of the last ended().
    bool stopped() const { return is_stopped_; }
    /// Waits for its end; false if it has not come in time, or cannot come.
    bool wait(std::chrono::milliseconds longest);

private:
    BusProcess(PipeMemory memory, Bell bell);

    PipeMemory memory_;
    Bell bell_;  ///< rings plab-bus
    MessageWriter writer_;
    MessageReader reader_;
    int lifeline_ = -1;
    pid_t pid_ = -1;
    bool is_gone_ = false, is_stopped_ = false;
    int status_ = 0;
};

/// plab-bus beside this program; PLAB_BUS_PROGRAM, where it is set, names another one.
std::string bus_program();

}  // namespace plab::bus
