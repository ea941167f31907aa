// Describes the results in sentences.
#include <algorithm>
#include <cmath>
#include <map>

#include "figures/axes.h"
#include "study/plot.h"
#include "study/write.h"

namespace plab::study
{
namespace
{

using figures::short_number;

std::string one_decimal(double v)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", v);
    return text;
}

std::string cost_of(const Point& p) { return short_number(1e3 * p.cpu_per_second()) + " ms"; }

std::string digits_of(const Point& p)
{
    const std::string d = p.error() == 0 ? "all digits" : one_decimal(digits(p.error())) + " digits";
    return p.is_resolved() || p.error() == 0 ? d : "at least " + d;
}

bool usable(const Point& p) { return p.record.ok() && std::isfinite(p.error()) && p.cpu_per_second() > 0; }

/// The best algorithms, and the cost of each accuracy.
void report_front(const StudyResult& r, std::vector<std::string>& out)
{
    const std::vector<std::size_t> front = plot::pareto_front(r);
    if (front.empty()) return;
    const Point& best = r.points[front.back()];
    const bool limit = best.error() <= plot::kRoundOff || !best.is_resolved();
    out.push_back(best.combination.label() +
                  (limit ? " is the cheapest of those without a resolvable error: " : " is the most accurate: ") + digits_of(best) +
                  " at " + cost_of(best) + " of CPU time per simulated second.");
    double compared = 0;
    for (const double wanted : {2.0, 4.0, 6.0, 9.0, 12.0})
    {
        const Point* cheapest = nullptr;
        const Point* second = nullptr;
        for (const Point& p : r.points)
        {
            if (!usable(p) || digits(p.error()) < wanted) continue;
            if (!cheapest || p.cpu_per_second() < cheapest->cpu_per_second()) cheapest = &p;
        }
        if (!cheapest || cheapest->cpu_per_second() == compared || cheapest == &best) continue;
        for (const Point& p : r.points)
            if (usable(p) && digits(p.error()) >= wanted && p.combination.algorithm != cheapest->combination.algorithm &&
                (!second || p.cpu_per_second() < second->cpu_per_second()))
                second = &p;
        compared = cheapest->cpu_per_second();
        std::string line = "For " + one_decimal(wanted).substr(0, one_decimal(wanted).size() - 2) + " digits take " +
                           cheapest->combination.label() + ": " + digits_of(*cheapest) + " at " + cost_of(*cheapest) +
                           " per simulated second";
        if (second)
            line += "; the next algorithm, " + second->combination.label() + ", costs " +
                    one_decimal(second->cpu_per_second() / cheapest->cpu_per_second()) + " times as much";
        out.push_back(line + ".");
    }
}

/// Algorithms that are never on the Pareto front.
void report_losers(const StudyResult& r, std::vector<std::string>& out)
{
    const std::vector<std::size_t> front = plot::pareto_front(r);
    std::vector<std::string> losers;
    for (const std::string& algorithm : plot::algorithms_of(r))
    {
        const bool there =
            std::any_of(front.begin(), front.end(), [&](std::size_t i) { return r.points[i].combination.algorithm == algorithm; });
        const bool runs = std::any_of(r.points.begin(), r.points.end(),
                                      [&](const Point& p) { return p.combination.algorithm == algorithm && usable(p); });
        if (!there && runs) losers.push_back(algorithm);
    }
    if (losers.empty() || front.empty()) return;
    std::string names;
    for (std::size_t i = 0; i < losers.size(); ++i) names += (i == 0 ? "" : i + 1 == losers.size() ? " and " : ", ") + losers[i];
    const bool one = losers.size() == 1;
    out.push_back(names + (one ? " is" : " are") + " never the best choice here: at each of " + (one ? "its" : "their") +
                  " costs another algorithm has an error that is no larger.");
}

/// Observed orders, from neighbouring step lengths well above round-off and the reference's uncertainty.
void report_orders(const StudyResult& r, std::vector<std::string>& out)
{
    double floor = 1e-12;
    for (const Distance& u : r.reference.uncertainty)
        if (u.series > 0) floor = std::max(floor, 10 * u.series);
    std::string line;
    for (const std::string& algorithm : plot::algorithms_of(r))
    {
        std::vector<const Point*> points;
        for (const Point& p : r.points)
            if (p.combination.algorithm == algorithm && usable(p) && p.error() > floor) points.push_back(&p);
        std::sort(points.begin(), points.end(), [](const Point* a, const Point* b) { return a->record.dt < b->record.dt; });
        if (points.size() < 2 || points[0]->record.dt == points[1]->record.dt) continue;
        const double order = std::log(points[1]->error() / points[0]->error()) / std::log(points[1]->record.dt / points[0]->record.dt);
        line += (line.empty() ? "" : "; ") + algorithm + " " + (order > 0.05 ? one_decimal(order) : "none");
    }
    if (!line.empty()) out.push_back("Observed order of convergence, from the two shortest steps above round-off: " + line + ".");
}

void report_failures(const StudyResult& r, std::vector<std::string>& out)
{
    std::map<std::string, std::vector<std::string>> by_outcome;
    std::map<std::string, std::string> why;  // of the first
    for (const Point& p : r.points)
    {
        if (p.record.ok()) continue;
        by_outcome[std::string(name_of(p.record.outcome))].push_back(p.combination.label());
        why.emplace(name_of(p.record.outcome), p.record.why);
    }
    for (const auto& [outcome, labels] : by_outcome)
    {
        std::string line = labels.size() == 1 ? "One run gave no result (" + outcome + "): "
                                              : std::to_string(labels.size()) + " runs gave no result (" + outcome + "): ";
        for (std::size_t i = 0; i < std::min<std::size_t>(labels.size(), 4); ++i) line += (i == 0 ? "" : ", ") + labels[i];
        line += labels.size() > 4 ? ", ..." : "";
        out.push_back(line + (labels.size() > 1 ? ". The first: " : ": ") + why[outcome] + ".");
    }
    int missed = 0;
    std::string combinations;
    for (const Point& p : r.points)
    {
        if (!p.contacts.known || p.contacts.missed == 0) continue;
        combinations += (missed == 0 ? "" : ", ") + p.combination.label() + " (" + std::to_string(p.contacts.missed) + " of " +
                        std::to_string(p.contacts.expected) + ")";
        if (++missed == 4) break;
    }
    if (missed > 0) out.push_back("Impacts of the reference that were missed: " + combinations + ".");
}

void report_energy(const StudyResult& r, std::vector<std::string>& out)
{
    const Point *best = nullptr, *worst = nullptr;
    int count = 0;
    for (const Point& p : r.points)
    {
        if (!p.record.ok() || !std::isfinite(p.energy_drift) || p.record.energy.scale <= 0) continue;
        ++count;
        if (!best || p.energy_drift < best->energy_drift) best = &p;
        if (!worst || p.energy_drift > worst->energy_drift) worst = &p;
    }
    if (!best) return;
    const std::string all = count > 1 ? " by all" : "";
    if (worst->energy_drift <= plot::kRoundOff) return out.push_back("Energy is kept to round-off" + all + ".");
    const auto figure = [](const Point* p) { return short_number(p->energy_drift) + " (" + p->combination.label() + ")"; };
    std::string range = count == 1 ? figure(best) : "from " + figure(best) + " to " + figure(worst);
    if (count > 1 && best->energy_drift == worst->energy_drift) range = short_number(best->energy_drift) + all;
    out.push_back("Unexplained energy, relative to the largest energy of the run: " + range + ".");
}

void report_limits(const StudyResult& r, std::vector<std::string>& out)
{
    int hidden = 0;
    std::string noisy;
    for (const Point& p : r.points)
    {
        hidden += p.record.ok() && std::isfinite(p.error()) && !p.is_resolved() && p.error() > 0 ? 1 : 0;
        if (p.record.allocations.value_or(0) > 0 && noisy.size() < 120)
            noisy += (noisy.empty() ? "" : ", ") + p.combination.label() + " (" + std::to_string(*p.record.allocations) + ")";
    }
    if (hidden > 0)
        out.push_back(std::to_string(hidden) + (hidden == 1 ? " run is" : " runs are") +
                      " as close to the reference as the reference is known: their errors are upper bounds.");
    if (!noisy.empty()) out.push_back("Allocations of memory in warm steps: " + noisy + ".");
    if (r.reference.kind == "auto" && !r.reference.converges) out.push_back("The reference is uncertain: " + r.reference.words + ".");
}

}  // namespace

std::vector<std::string> findings(const StudyResult& r)
{
    std::vector<std::string> out;
    report_front(r, out);
    report_losers(r, out);
    report_orders(r, out);
    report_energy(r, out);
    report_failures(r, out);
    report_limits(r, out);
    return out;
}

}  // namespace plab::study
