#include "control/recordings/segments.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace plab::recordings
{
namespace
{

std::string unit_of_error(const plab_v2_InteractionMetrics& m)
{
    for (std::uint32_t i = 0; i < m.outputs._length; ++i)
        if (const plab_v2_Parameter& p = m.outputs._buffer[i]; std::string_view(p.kind) == "account" && std::string_view(p.name) == "error")
            return p.unit;
    return {};
}

class SegmentCollector
{
public:
    void note(const plab_v2_Metrics& metrics, double time)
    {
        for (std::uint32_t i = 0; i < metrics.interactions._length; ++i) note(metrics.interactions._buffer[i], metrics, time);
    }
    std::vector<Segment> take()
    {
        std::vector<Segment> out;
        for (auto& [component, series] : series_)
            for (Segment& segment : series.segments) out.push_back(std::move(segment));
        return out;
    }

private:
    struct TimeSeries
    {
        std::vector<Segment> segments;
        double last_work = 0;        ///< J since the run began
        std::uint64_t measured = 0;  ///< samples of the last segment that have a cost
    };

    void note(const plab_v2_InteractionMetrics& m, const plab_v2_Metrics& all, double time)
    {
        TimeSeries& series = series_[m.component_id];
        const bool is_new_run = series.segments.empty() || series.segments.back().run != all.run;
        if (is_new_run || series.segments.back().algorithm != m.requested)
        {
            Segment& segment = series.segments.emplace_back();
            series.measured = 0;
            segment.component = m.component_id, segment.algorithm = m.requested, segment.run = all.run, segment.begin = time;
        }
        if (is_new_run) series.last_work = m.work;
        Segment& now = series.segments.back();
        now.resolved = m.resolved, now.end = time;
        ++now.samples;
        // The first sample of a run measures what was before it (is_measured in quantity.h).
        if (all.step_ns > 0 && !is_new_run) now.mean_cost += (m.cost_ns - now.mean_cost) / static_cast<double>(++series.measured);
        // A residual until the first shadow step, then the measured error: values of two units have no common maximum.
        if (const std::string unit = unit_of_error(m); std::exchange(now.error_unit, unit) != unit) now.largest_error = 0;
        // A comparison with NaN is false.
        if (!(std::fabs(m.error) <= now.largest_error)) now.largest_error = std::fabs(m.error);
        now.work += m.work - series.last_work;
        series.last_work = m.work;
    }

    std::map<std::string, TimeSeries> series_;
};

}  // namespace

std::vector<Segment> segments_of(const Log& log)
{
    SegmentCollector collector;
    Stream stream = log.stream({"plab/metrics"});
    while (const Entry* entry = stream.next())
        if (const auto* metrics = entry->as<plab_v2_Metrics>()) collector.note(*metrics, seconds(entry->log_time));
    return collector.take();
}

}  // namespace plab::recordings
