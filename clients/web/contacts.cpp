#include "web/contacts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "idl/samples.h"

namespace plab::web
{
namespace
{

/// Pages get contacts at most so often, and the bus is read so long after the last page has asked.
constexpr std::chrono::milliseconds kBetween(50), kPatience(2000);

/// Five digits: what a picture and a table need, as a short text.
double rounded(double v)
{
    char text[32];
    (void)std::snprintf(text, sizeof text, "%.5g", v);
    return std::isfinite(v) ? std::strtod(text, nullptr) : 0.0;
}

}  // namespace

Json contacts_message(const wire::ContactForces& contacts, const std::set<std::string>& watched)
{
    struct Point
    {
        const wire::ContactInfo* pair;
        const wire::ContactPoint* point;
        bool is_watched;
    };
    std::vector<Point> points;
    for (const wire::ContactInfo& pair : contacts.entries)
    {
        const bool is_watched = watched.contains(pair.a) || watched.contains(pair.b);
        for (const wire::ContactPoint& p : pair.points) points.push_back({&pair, &p, is_watched});
    }
    std::size_t left_out = contacts.left_out;
    if (points.size() > kMostContactPoints)
    {
        // Watched ones first, then by force; then in their order again.
        std::nth_element(points.begin(), points.begin() + kMostContactPoints, points.end(),
                         [](const Point& x, const Point& y)
                         {
                             if (x.is_watched != y.is_watched) return x.is_watched;
                             return x.point->normal_force > y.point->normal_force;
                         });
        left_out += points.size() - kMostContactPoints;
        points.resize(kMostContactPoints);
        std::sort(points.begin(), points.end(),
                  [](const Point& x, const Point& y) { return x.pair != y.pair ? x.pair < y.pair : x.point < y.point; });
    }
    Json pairs = Json::array(), rows = Json::array();
    const wire::ContactInfo* last = nullptr;
    for (const Point& p : points)
    {
        if (p.pair != last) pairs.push_back({p.pair->a, p.pair->b, p.pair->asleep});
        last = p.pair;
        const wire::ContactPoint& c = *p.point;
        Json row = Json::array({pairs.size() - 1});
        const auto add = [&](double v) { row.push_back(rounded(v)); };
        for (const Vec3& v : {c.position, c.normal, c.friction_force}) add(v.x), add(v.y), add(v.z);
        add(c.normal_force), add(c.depth);
        row.push_back(c.is_impact ? 1 : 0);
        rows.push_back(std::move(row));
    }
    return {{"type", "contacts"},   {"run", contacts.run},       {"time", contacts.time},
            {"left_out", left_out}, {"pairs", std::move(pairs)}, {"points", std::move(rows)}};
}

void ContactFeed::update(const std::set<std::string>& watched, const std::function<void(PageId, const Json&)>& send)
{
    const Clock::time_point now = Clock::now();
    const bool wanted = now - asked_at_ < kPatience;
    if (wanted != reader_.has_value())
    {
        reader_.reset();
        if (wanted)
            if (auto made = session_.reader<plab_v2_ContactForces>()) reader_ = made.take();
    }
    if (!reader_) return;
    // A sample that nobody takes now is replaced by a newer one.
    if (waiting_.empty() || now - sent_at_ < kBetween) return;
    bool any = false;
    (void)reader_->take(
        [&](const plab_v2_ContactForces& sample, const dds_sample_info_t& info)
        {
            if (info.valid_data) wire::read_sample(sample, contacts_), any = true;
        });
    if (!any) return;
    sent_at_ = now;
    const Json message = contacts_message(contacts_, watched);
    for (const PageId page : std::exchange(waiting_, {})) send(page, message);
}

}  // namespace plab::web
