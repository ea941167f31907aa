#include "study/reference.h"

#include <algorithm>
#include <cmath>

#include "exact/closed_form.h"
#include "model/numbers.h"
#include "plab/rotation.h"

namespace plab::study
{
namespace
{

/// Differences of runs below this are round-off: no order can be derived from them.
constexpr double kRoundOff = 2e-14;

/// Lower orders do not belong to any method: they come from an event or a jump, and may change with the next halving.
constexpr double kLeastOrder = 0.9;
/// With slower convergence, differences do not show the remaining distance.
constexpr double kSlowestConvergence = 0.2;

/// y4 + share (y4 - y2); attitudes along the geodesic.
void extrapolate(const Quantity& q, std::span<const double> y2, std::span<const double> y4, double share, std::vector<double>& out)
{
    if (q.measure == Measure::Geodesic)
    {
        const Quat a{y2[0], y2[1], y2[2], y2[3]}, b{y4[0], y4[1], y4[2], y4[3]};
        const Quat r = normalized(b * exp_rotation(log_rotation(conjugate(a) * b) * share));
        out.insert(out.end(), {r.w, r.x, r.y, r.z});
        return;
    }
    for (std::size_t i = 0; i < y4.size(); ++i) out.push_back(y4[i] + share * (y4[i] - y2[i]));
}

/// The order to extrapolate with; 0: none.
double usable_order(double seen)
{
    if (!(seen >= kLeastOrder) || seen > 14) return 0;
    const double whole = std::round(seen);
    return std::fabs(seen - whole) < 0.25 ? whole : seen;
}

Distance times(const Distance& d, double factor)
{
    return {d.series * factor, d.last * factor, d.series_absolute * factor, d.last_absolute * factor};
}

Distance larger(const Distance& a, const Distance& b)
{
    return {std::max(a.series, b.series), std::max(a.last, b.last), std::max(a.series_absolute, b.series_absolute),
            std::max(a.last_absolute, b.last_absolute)};
}

/// The possible distance of y4 from the exact value if it is used unchanged.
Distance doubt(const Distance& far, const Distance& near, double seen)
{
    const Distance most = larger(far, near);
    if (!(seen < kLeastOrder)) return most;
    const double share = 1 / (std::pow(2.0, std::max(seen, kSlowestConvergence)) - 1);
    return larger(most, times(seen > kSlowestConvergence ? near : most, share));
}

void add_quantity(Reference& out, const Quantity& q, const TimeSeries& y1, const TimeSeries& y2, const TimeSeries& y4)
{
    const double scale = scale_of(y4);
    const Distance far = distance(q, y1, y2, scale), near = distance(q, y2, y4, scale);
    const bool round_off = near.series <= kRoundOff && far.series <= 16 * kRoundOff;
    const double seen = round_off ? kNaN : std::log2(far.series / near.series), p = round_off ? 0 : usable_order(seen);
    TimeSeries series{q.width, {}};
    const double share = p > 0 ? 1 / (std::pow(2.0, p) - 1) : 0;
    for (std::size_t i = 0; i < y4.samples(); ++i) extrapolate(q, y2.at(i), y4.at(i), share, series.values);
    out.converged.push_back(round_off || p > 0), out.converges = out.converges && out.converged.back();
    out.order.push_back(seen);
    out.scale.push_back(scale_of(series));
    out.uncertainty.push_back(p > 0 ? times(near, share) : doubt(far, near, seen));
    out.time_series.push_back(std::move(series));
}

/// "; not converged, the finest run is used unchanged: ball.position (observed order 0.62)"
std::string unsure(const Reference& r, const std::vector<Quantity>& quantities)
{
    std::string out;
    for (std::size_t k = 0; k < quantities.size(); ++k)
        if (!r.converged[k])
        {
            char order[40];
            std::snprintf(order, sizeof order, " (observed order %.2f)", r.order[k]);
            out += (out.empty() ? "" : ", ") + quantities[k].name + (std::isfinite(r.order[k]) ? order : "");
        }
    return "; not converged, the finest run is used unchanged: " + out;
}

std::vector<std::string> split(const std::string& line)
{
    std::vector<std::string> out;
    std::size_t from = 0;
    while (true)
    {
        const std::size_t comma = line.find(',', from);
        out.push_back(line.substr(from, comma - from));
        if (comma == std::string::npos) return out;
        from = comma + 1;
    }
}

double number_or_nan(const std::string& text)
{
    char* end = nullptr;
    const double v = std::strtod(text.c_str(), &end);
    return end == text.c_str() ? kNaN : v;
}

struct FileCloser
{
    void operator()(std::FILE* f) const { std::fclose(f); }
};

bool read_line(std::FILE* f, std::string& line)
{
    line.clear();
    for (int c = std::fgetc(f); c != EOF; c = std::fgetc(f))
    {
        if (c == '\n') return true;
        if (c != '\r') line += static_cast<char>(c);
    }
    return !line.empty();
}

/// The columns that hold a quantity's numbers.
Result<std::vector<std::size_t>> columns_of(const Quantity& q, const std::vector<std::string>& header, const std::string& path)
{
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < q.width; ++i)
    {
        const std::string name = q.column(i);
        const auto found = std::find(header.begin(), header.end(), name);
        if (found == header.end()) return reason(path + " has no column '" + name + "' for the quantity " + q.name);
        out.push_back(static_cast<std::size_t>(found - header.begin()));
    }
    return out;
}

}  // namespace

Reference no_reference(std::size_t quantities, const std::string& why)
{
    Reference out;
    out.kind = "none", out.trouble = why, out.words = "no reference: " + why;
    out.time_series.resize(quantities), out.scale.assign(quantities, 1), out.order.assign(quantities, kNaN);
    out.uncertainty.assign(quantities, {kNaN, kNaN, kNaN, kNaN});
    return out;
}

/// The numbers of a quantity at t; NaN where the closed form does not cover it.
void read_exact(const exact::Solution& solution, const world::World& world, const Quantity& q, double t, std::vector<double>& out)
{
    const std::size_t before = out.size();
    const auto put = [&](std::initializer_list<double> v)
    {
        if (q.part)
            out.push_back(v.begin()[*q.part]);
        else
            out.insert(out.end(), v);
    };
    const auto put_vector = [&](const Vec3& v) { put({v.x, v.y, v.z}); };
    exact::State s;
    const std::uint32_t i = world.find(q.id);
    if (i != kNoIndex && solution.state(q.id, t, s))
    {
        const bool body = world.component(i).facet == Facet::Body;
        const Vec3 offset = body ? -1.0 * rotate(s.orientation, world.host().bodies.center_B[world.component(i).host_index]) : Vec3{};
        if (body && q.field == "position") put_vector(s.position + offset);
        if (body && q.field == "linear_velocity") put_vector(s.velocity + cross(s.angular_velocity, offset));
        if (q.field == "orientation") put({s.orientation.w, s.orientation.x, s.orientation.y, s.orientation.z});
        if (body && q.field == "angular_velocity") put_vector(s.angular_velocity);
        if (!body && q.field == "angle") put({s.angle});
        if (!body && q.field == "angular_velocity") put({s.speed});
    }
    out.resize(before + q.width, std::numeric_limits<double>::quiet_NaN());
}

Result<Reference> exact_reference(model::TypeSource& types, const model::SceneSpec& scene, const RunOptions& options,
                                  const std::string& text)
{
    simulation::Simulation s(types, 1);
    if (auto loaded = s.load(scene); !loaded) return loaded.errors();
    const double until = options.sample_times.empty() ? options.until : options.sample_times.back();
    auto made = exact::make_solution(text, s, until);
    if (!made) return made.errors();
    const exact::Solution& solution = **made;
    Reference out;
    out.kind = "exact", out.words = solution.words(), out.times = options.sample_times;
    for (const std::string& name : options.quantities)
    {
        const auto q = resolve_quantity(s.world(), name);
        if (!q) return q.errors();
        TimeSeries series{q->width, {}};
        for (const double t : out.times) read_exact(solution, s.world(), *q, t, series.values);
        if (std::isnan(series.values.front()))
            return reason("the closed form '" + text + "' does not predict " + name + ": compare other quantities, such as a position");
        out.scale.push_back(scale_of(series));
        out.time_series.push_back(std::move(series));
        const double known = solution.precision(until), absolute = q->measure == Measure::Geodesic ? known : known * out.scale.back();
        out.uncertainty.push_back({known, known, absolute, absolute});
        out.order.push_back(kNaN);
    }
    out.knows_contacts = solution.knows_contacts();
    if (out.knows_contacts)
        for (const exact::ContactStart& c : solution.contacts(until)) out.contacts.push_back({c.kind, c.a, c.b, c.time});
    return out;
}

Result<Reference> file_reference(const std::vector<Quantity>& quantities, const std::vector<double>& times, const std::string& path)
{
    const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.c_str(), "r"));
    if (!file) return reason("cannot read the reference " + path);
    std::string line;
    if (!read_line(file.get(), line))
        return reason(path + " is empty: a reference must be a CSV file written by plabd --trace or plab-study");
    const std::vector<std::string> header = split(line);
    if (header.front() != "time") return reason(path + " is not such a CSV file: its first column is '" + header.front() + "', not 'time'");
    std::vector<std::vector<std::size_t>> columns;
    for (const Quantity& q : quantities)
    {
        auto found = columns_of(q, header, path);
        if (!found) return found.errors();
        columns.push_back(found.take());
    }
    Reference out;
    out.kind = "file", out.words = "the file " + path, out.times = times;
    for (const Quantity& q : quantities) out.time_series.push_back({q.width, {}});
    std::vector<std::string> cells;
    for (const double t : times)
    {
        const double slack = 1e-9 * std::max(1.0, std::fabs(t));
        while (cells.empty() || number_or_nan(cells[0]) < t - slack)
        {
            if (!read_line(file.get(), line)) return reason(path + " ends before t = " + model::format_real(t) + " s");
            cells = split(line);
        }
        if (std::fabs(number_or_nan(cells[0]) - t) > slack)
            return reason(path + " has no row at t = " + model::format_real(t) +
                          " s: write it with an --every that divides the step lengths studied");
        for (std::size_t k = 0; k < quantities.size(); ++k)
            for (const std::size_t c : columns[k]) out.time_series[k].values.push_back(c < cells.size() ? number_or_nan(cells[c]) : kNaN);
    }
    for (const TimeSeries& c : out.time_series) out.scale.push_back(scale_of(c));
    out.uncertainty.assign(quantities.size(), {kNaN, kNaN, kNaN, kNaN});
    out.order.assign(quantities.size(), kNaN);
    return out;
}

Reference auto_reference(const std::vector<RunRecord>& runs, const std::string& algorithm, const std::string& dt)
{
    const RunRecord &y1 = runs[0], &y2 = runs[1], &y4 = runs[2];
    for (const RunRecord& r : runs)
        if (!r.ok())
            return no_reference(r.quantities.size(),
                                algorithm + ", which was to be the reference, " + std::string(name_of(r.outcome)) + ": " + r.why);
    Reference out;
    out.kind = "auto", out.times = y4.times;
    for (std::size_t k = 0; k < y4.quantities.size(); ++k)
        add_quantity(out, y4.quantities[k], y1.time_series[k], y2.time_series[k], y4.time_series[k]);
    out.knows_contacts = true, out.contacts = y4.contacts;
    out.words =
        algorithm + " with dt = " + dt + " s, halved twice" + (out.converges ? ", extrapolated by Richardson" : unsure(out, y4.quantities));
    return out;
}

}  // namespace plab::study
