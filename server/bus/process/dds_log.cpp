#include "bus/process/dds_log.h"

#include <dds/dds.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace plab::bus
{
namespace
{

constexpr std::size_t kLongest = 200;  ///< longest line, bytes

}  // namespace

DdsLog::DdsLog()
{
    // One line per call. It may come from any thread of DDS.
    const auto hear = [](void* self, const dds_log_data_t* data)
    {
        auto& log = *static_cast<DdsLog*>(self);
        if (!log.gathers_.load(std::memory_order_relaxed) || (data->priority & DDS_LC_FATAL) != 0)
            (void)std::fprintf(stderr, "%.*s\n", static_cast<int>(data->size), data->message);
        log.add(data->message, data->size);
    };
    dds_set_log_sink(hear, this);
}

DdsLog::~DdsLog() { dds_set_log_sink(nullptr, nullptr); }

DdsLog::Said DdsLog::take()
{
    const std::lock_guard guard(mutex_);
    return std::exchange(said_, {});
}

void DdsLog::add(const char* text, std::size_t size)
{
    const std::lock_guard guard(mutex_);
    ++said_.lines;
    said_.last.assign(text, std::min(size, kLongest));
    // The text may contain data of a malformed packet.
    for (char& c : said_.last)
        if (static_cast<unsigned char>(c) >= 0x80) c = '?';
}

}  // namespace plab::bus
