/// Collects and counts the log output of DDS, so that malformed packets cannot flood the log.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

namespace plab::bus
{

/// Receives everything that Cyclone DDS logs in this process.
class DdsLog
{
public:
    DdsLog();
    ~DdsLog();
    DdsLog(const DdsLog&) = delete;
    DdsLog& operator=(const DdsLog&) = delete;

    /// From now on, only fatal errors also go to standard error.
    void gather() { gathers_.store(true, std::memory_order_relaxed); }
    /// Since the last call: the number of lines, and the last of them.
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
