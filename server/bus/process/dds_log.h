/// What DDS says, gathered and counted, so that packets which nobody should send fill no log.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

namespace plab::bus
{

/// Hears all that Cyclone says in this process.
class DdsLog
{
public:
    DdsLog();
    ~DdsLog();
    DdsLog(const DdsLog&) = delete;
    DdsLog& operator=(const DdsLog&) = delete;

    /// From now on only what is fatal goes to standard error, too.
    void gather() { gathers_.store(true, std::memory_order_relaxed); }
    /// Since the last time: how many lines, and the last of them.
    struct Said
    {
        std::uint64_t lines = 0;
        std::string last;
    };
    Said take();

private:
    void add(const char* text, std::size_t size);

    std::atomic<bool> gathers_{false};
    std::mutex mutex_;
    Said said_;
};

}  // namespace plab::bus
