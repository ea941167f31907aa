/// What DDS says: gathered, so that packets which nobody should send fill no log, and counted.
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

    /// From now on nothing goes to standard error but what is fatal.
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
