#include "control/recording/analysis/curves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace plab::analysis
{
namespace
{

using figures::Moment;

/// Each quantity with its series.
class TimeSeriesSet
{
public:
    TimeSeriesSet(const Log& log, const std::vector<Signal>& quantities, const Extent& extent) : log_(&log)
    {
        for (const Signal& q : quantities) series_.push_back({q, Thinned(extent.begin, extent.end), {}, {}});
    }

    void note(const Entry& entry)
    {
        if (const auto* frame = entry.as<plab_v2_Frame>()) note_frame(*frame, seconds(entry.log_time));
        if (const auto* metrics = entry.as<plab_v2_Metrics>()) note_metrics(*metrics, seconds(entry.log_time));
    }

    std::vector<figures::Curve> take()
    {
        std::vector<figures::Curve> out;
        for (TimeSeries& c : series_) out.push_back({c.quantity.name(), c.quantity.unit, c.series.take()});
        return out;
    }

private:
    struct TimeSeries
    {
        Signal quantity;
        Thinned series;
        std::optional<std::uint64_t> run;     ///< of the last value
        std::optional<std::uint32_t> handle;  ///< in that run
    };

    /// True at the first sample of a run.
    bool begin_run(TimeSeries& c, std::uint64_t run) const
    {
        if (c.run == run) return false;
        if (c.run) c.series.interrupt();
        c.run = run, c.handle = log_->things().handle_of(run, c.quantity.id);
        return true;
    }

    void note_frame(const plab_v2_Frame& frame, double time)
    {
        merged_.note(frame);
        for (TimeSeries& c : series_)
        {
            if (c.quantity.source != Signal::Source::Object) continue;
            (void)begin_run(c, frame.run);
            if (!c.handle) continue;
            const plab_v2_BodyState* const body = merged_.find_body(*c.handle);
            const plab_v2_ShaftState* const shaft = body == nullptr ? merged_.find_shaft(*c.handle) : nullptr;
            if (const auto value = body != nullptr    ? value_of(c.quantity, *body)
                                   : shaft != nullptr ? value_of(c.quantity, *shaft)
                                                      : std::nullopt)
                c.series.add(time, *value);
        }
    }

    void note_metrics(const plab_v2_Metrics& metrics, double time)
    {
        for (TimeSeries& c : series_)
        {
            if (c.quantity.source == Signal::Source::Object) continue;
            if (begin_run(c, metrics.run) && is_measured(c.quantity)) continue;
            const auto value = value_of(c.quantity, metrics);
            if (!value) continue;
            if (c.series.empty() && c.quantity.unit.empty()) c.quantity.unit = unit_in(c.quantity, metrics);
            c.series.add(time, *value);
        }
    }

    const Log* log_;
    std::vector<TimeSeries> series_;
    Merged merged_;
};

std::string words_of(const Swap& swap) { return swap.component + ": " + (swap.from.empty() ? "" : swap.from + " ") + "→ " + swap.to; }

/// Several marks of one kind in a step are merged.
void add_events(const Entry& entry, bool all, std::vector<Moment>& out)
{
    const auto* events = entry.as<plab_v2_Events>();
    if (events == nullptr) return;
    for (std::uint32_t i = 0; i < events->entries._length; ++i)
    {
        const plab_v2_EventInfo& e = events->entries._buffer[i];
        const bool is_info = std::string_view(e.severity) == "info";
        if (is_info && !all) continue;
        const std::string words = std::string(e.kind) + ": " + e.component_id + " " + e.message;
        const double at = seconds(entry.log_time);
        if (!out.empty() && out.back().at == at && out.back().words == words) continue;
        out.push_back({at, is_info ? Moment::Kind::Notice : Moment::Kind::Alarm, words});
    }
}

/// Selects as many marks as a diagram has room for, evenly; their order stays.
void thin(std::vector<Moment>& moments, const Extent& extent)
{
    constexpr double kPlaces = 600;
    std::set<std::pair<Moment::Kind, long>> taken;
    std::erase_if(moments,
                  [&](const Moment& m)
                  {
                      if (m.kind == Moment::Kind::Change || m.kind == Moment::Kind::Break) return false;
                      const double share = (m.at - extent.begin) / std::max(extent.end - extent.begin, 1e-9);
                      return !taken.insert({m.kind, std::lround(share * kPlaces)}).second;
                  });
}

}  // namespace

void Thinned::add(double time, double value)
{
    if (!std::isfinite(value)) return interrupt();
    const double place = std::floor((time - begin_) / width_);
    const auto number = place > 0 ? static_cast<std::size_t>(place) : 0;
    if (slot_.count > 0 && number != slot_.number) flush();
    const std::pair<double, double> point{time, value};
    if (slot_.count++ == 0) slot_ = {number, 1, point, point, point, point};
    if (value < slot_.least.second) slot_.least = point;
    if (value > slot_.greatest.second) slot_.greatest = point;
    slot_.last = point;
    ++count_;
    largest_ = std::max(largest_, std::fabs(value));
}

void Thinned::flush()
{
    std::array<std::pair<double, double>, 4> points{slot_.first, slot_.least, slot_.greatest, slot_.last};
    std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const auto end = std::unique(points.begin(), points.end());
    points_.insert(points_.end(), points.begin(), end);
    slot_ = {};
}

void Thinned::interrupt()
{
    if (slot_.count > 0) flush();
    if (!points_.empty() && std::isfinite(points_.back().second))
        points_.emplace_back(points_.back().first, std::numeric_limits<double>::quiet_NaN());
}

std::vector<std::pair<double, double>> Thinned::take()
{
    if (slot_.count > 0) flush();
    return std::move(points_);
}

Extent extent_of(const Log& log, const Span& span)
{
    const recording::Statistics& s = log.reader().index().statistics;
    Extent out{seconds(s.start_time), seconds(s.end_time)};
    if (span.from) out.begin = std::max(out.begin, *span.from);
    if (span.to) out.end = std::min(out.end, *span.to);
    return out;
}

std::vector<figures::Curve> curves_of(const Log& log, const std::vector<Signal>& quantities, const Span& span)
{
    const auto is_of = [](Signal::Source source) { return [source](const Signal& q) { return q.source == source; }; };
    std::vector<std::string> topics;
    if (std::any_of(quantities.begin(), quantities.end(), is_of(Signal::Source::Object))) topics.push_back("plab/states");
    if (!std::all_of(quantities.begin(), quantities.end(), is_of(Signal::Source::Object))) topics.push_back("plab/metrics");
    TimeSeriesSet series_set(log, quantities, extent_of(log, span));
    Stream stream = log.stream(topics, span);
    while (const Entry* entry = stream.next()) series_set.note(*entry);
    return series_set.take();
}

std::vector<Moment> moments_of(const Log& log, const Span& span, bool all_events)
{
    std::vector<Moment> out;
    Runs runs;
    Swaps swaps;
    // Metrics also show runs that began without a request.
    Stream stream = log.stream({"plab/events", "plab/journal", "plab/metrics", "plab/scene"}, span);
    while (const Entry* entry = stream.next())
    {
        runs.note(*entry);
        swaps.note(*entry);
        add_events(*entry, all_events, out);
        if (out.size() > 100'000) thin(out, extent_of(log, span));
    }
    thin(out, extent_of(log, span));
    for (std::size_t i = 1; i < runs.all().size(); ++i)
    {
        const Run& run = runs.all()[i];
        out.push_back(
            {seconds(run.begin), Moment::Kind::Break, "run " + std::to_string(run.number) + (run.cause.empty() ? "" : ": " + run.cause)});
    }
    for (const Swap& swap : swaps.all(log.things())) out.push_back({seconds(swap.log_time), Moment::Kind::Change, words_of(swap)});
    std::stable_sort(out.begin(), out.end(), [](const Moment& a, const Moment& b) { return a.at < b.at; });
    return out;
}

}  // namespace plab::analysis
