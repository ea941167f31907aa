/// Collects write errors: at most one log line per second and topic, however often the error occurs.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <map>
#include <string>

namespace plab::bus
{

class Trouble
{
public:
    using Log = void (*)(void* argument, const char* line);
    Trouble(Log log, void* argument) : log_(log), argument_(argument) {}

    /// Counts `code` if it is an error. True if it is not an error.
    bool check(const char* topic, dds_return_t code);
    /// Total since the start.
    std::uint64_t lost(const char* topic) const;
    /// Logs what was counted since the last call.
    void report();
    void say(const std::string& line) const;

private:
    struct Count
    {
        std::uint64_t all = 0, since_report = 0;
        dds_return_t last = DDS_RETCODE_OK;
    };
    Log log_;
    void* argument_;
    std::map<std::string, Count, std::less<>> counts_;  // by topic
};

}  // namespace plab::bus
