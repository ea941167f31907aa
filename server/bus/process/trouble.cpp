#include "bus/process/trouble.h"

#include <cstdio>

namespace plab::bus
{

bool Trouble::check(const char* topic, dds_return_t code)
{
    if (code == DDS_RETCODE_OK) return true;
    Count& count = counts_[topic];
    ++count.all, ++count.since_report;
    count.last = code;
    return false;
}

std::uint64_t Trouble::lost(const char* topic) const
{
    const auto found = counts_.find(topic);
    return found == counts_.end() ? 0 : found->second.all;
}

void Trouble::report()
{
    for (auto& [topic, count] : counts_)
    {
        if (count.since_report == 0) continue;
        say(topic + ": " + std::to_string(count.since_report) + " samples could not be written: " + dds_strretcode(count.last));
        count.since_report = 0;
    }
}

void Trouble::say(const std::string& line) const
{
    if (log_ != nullptr)
        log_(argument_, line.c_str());
    else
        (void)std::fprintf(stderr, "bus: %s\n", line.c_str());
}

}  // namespace plab::bus
