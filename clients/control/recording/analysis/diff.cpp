#include "control/recording/analysis/diff.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "control/recording/analysis/compare.h"
#include "control/recording/analysis/curves.h"

namespace plab::analysis
{
namespace
{

/// The hashes of a recording, one by one.
class Hashes
{
public:
    struct One
    {
        When when;
        std::uint64_t value = 0;
    };

    explicit Hashes(const Log& log) : stream_(log.stream({"plab/hashes"})), runs_(log.runs()) {}

    std::optional<One> next()
    {
        while (at_ == values_.size())
        {
            const Entry* const entry = stream_.next();
            if (entry == nullptr) return {};
            const auto* hashes = entry->as<plab_v2_Hashes>();
            if (hashes == nullptr) continue;
            runs_.note(*entry);
            values_.assign(hashes->values._buffer, hashes->values._buffer + hashes->values._length);
            first_ = {*runs_.index_of(hashes->run), hashes->step};
            at_ = 0;
        }
        ++count_;
        One out{first_, values_[at_]};
        out.when.step += static_cast<std::int64_t>(at_++);
        return out;
    }
    std::uint64_t count() const { return count_; }
    /// The runs that the recording has, according to the log and the hashes.
    std::size_t runs() const { return runs_.all().size(); }

private:
    Stream stream_;
    Runs runs_;
    std::vector<std::uint64_t> values_;
    std::size_t at_ = 0;
    When first_;
    std::uint64_t count_ = 0;
};

void compare_hashes(const Log& log_a, const Log& log_b, Difference& out)
{
    Hashes a(log_a), b(log_b);
    auto in_a = a.next(), in_b = b.next();
    while (in_a && in_b)
    {
        if (in_a->when == in_b->when)
        {
            ++out.hashes_compared;
            if (in_a->value != in_b->value && !out.first_hash)
                out.first_hash = {in_a->when.run + 1, in_a->when.step, in_a->value, in_b->value};
        }
        const bool a_is_behind = in_a->when < in_b->when, b_is_behind = in_b->when < in_a->when;
        if (!b_is_behind) in_a = a.next();
        if (!a_is_behind) in_b = b.next();
    }
    while (in_a) in_a = a.next();
    while (in_b) in_b = b.next();
    out.hashes_a = a.count(), out.hashes_b = b.count();
    out.runs_a = a.runs(), out.runs_b = b.runs();
}

double angle_between(const plab_v2_Rotation& p, const plab_v2_Rotation& q)
{
    // From the length of the chord: accurate for small angles, unlike the arc cosine of a product.
    const double sign = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0 ? -1 : 1;
    const double w = p.w - sign * q.w, x = p.x - sign * q.x, y = p.y - sign * q.y, z = p.z - sign * q.z;
    return 4 * std::asin(std::min(1.0, 0.5 * std::sqrt(w * w + x * x + y * y + z * z)));
}

double distance(const plab_v2_Vector& p, const plab_v2_Vector& q) { return std::hypot(p.x - q.x, p.y - q.y, p.z - q.z); }

class GrowthTable
{
public:
    void note(const ComparedObject& object, double time)
    {
        Growth& growth = objects_[object.id];
        growth.object = object.id, growth.is_shaft = object.shaft_a != nullptr;
        const double size = size_of(object.differences);
        growth.largest = std::max(growth.largest, size);
        for (std::size_t i = 0; i < kExceeded.size(); ++i)
            if (size > kExceeded[i] && !growth.exceeded[i]) growth.exceeded[i] = time;
        if (growth.is_shaft)
            growth.position = std::fabs(object.shaft_a->angle - object.shaft_b->angle),
            growth.velocity = std::fabs(object.shaft_a->speed - object.shaft_b->speed);
        else
            note_final(growth, *object.body_a, *object.body_b);
    }
    std::vector<Growth> take()
    {
        std::vector<Growth> out;
        for (auto& [id, growth] : objects_) out.push_back(std::move(growth));
        std::stable_sort(out.begin(), out.end(), [](const Growth& x, const Growth& y) { return x.largest > y.largest; });
        return out;
    }

private:
    static void note_final(Growth& growth, const plab_v2_BodyState& a, const plab_v2_BodyState& b)
    {
        growth.position = distance(a.position, b.position), growth.orientation = angle_between(a.orientation, b.orientation);
        growth.velocity = distance(a.linear_velocity, b.linear_velocity);
        growth.angular_velocity = distance(a.angular_velocity, b.angular_velocity);
    }

    std::map<std::string, Growth> objects_;
};

/// If several components differ, the first in their order.
void note_first(const ComparedObject& object, const ComparedFrame& frame, Difference& out)
{
    if (out.first_state) return;
    for (const ComponentPair& pair : object.differences)
    {
        if (size_of(pair) == 0) continue;
        out.first_state = {frame.when.run + 1, frame.when.step, frame.time, object.id, std::string(pair.name), pair.a, pair.b};
        return;
    }
}

/// The n-th run is compared with the n-th: additional runs of one recording have no partner.
void note_single_runs(Difference& out)
{
    for (std::size_t run = std::min(out.runs_a, out.runs_b) + 1; run <= std::max(out.runs_a, out.runs_b); ++run)
        out.not_compared.push_back({run, out.runs_a > out.runs_b});
}

}  // namespace

Difference difference_of(const Log& a, const Log& b)
{
    Difference out;
    compare_hashes(a, b, out);
    note_single_runs(out);
    Comparison comparison(a, b);
    GrowthTable growth;
    while (comparison.next())
        comparison.for_each(
            [&](const ComparedObject& object)
            {
                note_first(object, comparison.frame(), out);
                growth.note(object, comparison.frame().log_time);
            });
    out.frames_a = comparison.frames_a(), out.frames_b = comparison.frames_b(), out.frames_compared = comparison.compared();
    out.only_in_a = comparison.only_in_a(), out.only_in_b = comparison.only_in_b();
    out.objects = growth.take();
    out.troubles_a = a.troubles(), out.troubles_b = b.troubles();
    out.troubles_a.merge(comparison.troubles_a()), out.troubles_b.merge(comparison.troubles_b());
    return out;
}

figures::Chart difference_chart(const Log& a, const Log& b, const std::vector<std::string>& objects)
{
    const Extent extent = extent_of(a, {});
    std::map<std::string, Thinned> series;
    for (const std::string& id : objects) series.emplace(id, Thinned(extent.begin, extent.end));
    Comparison comparison(a, b);
    while (comparison.next())
        comparison.for_each(
            [&](const ComparedObject& object)
            {
                if (const auto found = series.find(object.id); found != series.end())
                    found->second.add(comparison.frame().log_time, size_of(object.differences));
            });
    figures::Chart chart;
    chart.title = "Growth of the difference", chart.subtitle = a.path() + " and " + b.path();
    chart.kind = figures::Scale::Kind::Log;
    for (const std::string& id : objects) chart.curves.push_back({id, "largest difference, m, rad, m/s, rad/s", series.at(id).take()});
    chart.moments = moments_of(a, {}, false);
    return chart;
}

}  // namespace plab::analysis
