#include "web/metrics_text.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include "link/text.h"

namespace plab::web
{
namespace
{

using Labels = std::initializer_list<std::pair<const char*, std::string>>;

constexpr double kNano = 1e9;  ///< a division rounds once: 250 ns are 2.5e-07 s

std::string label_text(const std::string& text)
{
    std::string out;
    for (const char c : text)
    {
        if (c == '\\' || c == '"') out += '\\';
        out += c == '\n' ? std::string("\\n") : std::string(1, c);
    }
    return out;
}

std::string value_text(double value)
{
    if (std::isnan(value)) return "NaN";
    if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
    return link::number_text(value);
}

/// Samples of one name must follow one another, below what the name means.
class Text
{
public:
    void begin(const char* name, const char* type, const char* help)
    {
        name_ = name;
        out_ += std::string("# HELP ") + name + " " + help + "\n# TYPE " + name + " " + type + "\n";
    }
    void add(double value, Labels labels = {})
    {
        out_ += name_;
        const char* before = "{";
        for (const auto& [label, text] : labels)
        {
            out_ += std::string(before) + label + "=\"" + label_text(text) + "\"";
            before = ",";
        }
        out_ += std::string(labels.size() > 0 ? "} " : " ") + value_text(value) + "\n";
    }
    void one(const char* name, const char* type, const char* help, double value)
    {
        begin(name, type, help);
        add(value);
    }
    std::string take() { return std::move(out_); }

private:
    std::string out_;
    const char* name_ = "";
};

void add_server(const link::ServerInfo& s, Text& text)
{
    text.begin("plab_server_info", "gauge", "The server; always 1.");
    text.add(1, {{"server", s.name}, {"version", s.version}, {"scene", s.scene_file}});
    text.one("plab_process_start_time_seconds", "gauge", "When the server started, since 1970.", static_cast<double>(s.started_ns) / kNano);
    text.one("plab_run", "gauge", "Number of the run: counts loads and resets.", static_cast<double>(s.run));
    text.one("plab_revision", "gauge", "Structural requests applied since the server started.", static_cast<double>(s.revision));
    text.one("plab_step", "gauge", "Steps of this run.", static_cast<double>(s.step));
    text.one("plab_simulated_time_seconds", "gauge", "Time of the run.", s.time);
    text.one("plab_step_length_seconds", "gauge", "Simulated time of a step.", s.dt);
    text.one("plab_paused", "gauge", "1 while the run is paused.", s.paused ? 1 : 0);
    text.one("plab_real_time_factor_asked", "gauge", "Simulated seconds for each second; 0: as fast as possible.", s.rate_asked);
    text.one("plab_real_time_factor", "gauge", "The same as it was reached over the last second.", s.rate_reached);
    text.one("plab_slipped_seconds_total", "counter", "Simulated time that was lost because steps took too long.", s.slipped);
    text.one("plab_threads", "gauge", "Threads that compute steps.", s.threads);
    text.begin("plab_requests_total", "counter", "Requests since the server started, by outcome.");
    text.add(static_cast<double>(s.requests_done), {{"outcome", "done"}});
    text.add(static_cast<double>(s.requests_refused), {{"outcome", "refused"}});
    text.one("plab_events_total", "counter", "Events since the server started.", static_cast<double>(s.last_event));
    text.one("plab_collisions_total", "counter", "Collisions since the server started.", static_cast<double>(s.last_collision));
    text.begin("plab_dropped_samples_total", "counter", "Frames and other samples that the server dropped, by topic.");
    for (const auto& dropped : s.dropped) text.add(static_cast<double>(dropped.samples), {{"topic", dropped.topic}});
    if (s.recording.file.empty()) return;
    text.one("plab_recording_bytes", "gauge", "Size of the file that the server records to.", static_cast<double>(s.recording.bytes));
    text.one("plab_recording_dropped_messages_total", "counter", "Messages that the recording lost.",
             static_cast<double>(s.recording.dropped));
}

void add_scene(const Figures& f, Text& text)
{
    text.begin("plab_objects", "gauge", "Objects of the scene, by what they are.");
    text.add(static_cast<double>(f.bodies), {{"kind", "body"}});
    text.add(static_cast<double>(f.shafts), {{"kind", "shaft"}});
    text.one("plab_interactions", "gauge", "Interactions, solvers and other components that are no objects.",
             static_cast<double>(f.interactions));
    const link::Metrics& m = f.metrics;
    text.one("plab_step_duration_seconds", "gauge", "Processor time of a step, median of the last steps.", m.step_ns / kNano);
    text.one("plab_contacts", "gauge", "Pairs in contact.", m.contacts);
    text.one("plab_deepest_penetration_meters", "gauge", "At the end of the last step.", m.deepest);
    text.one("plab_residual_meters_per_second", "gauge", "Left over by contact responses in the last step.", m.residual);
    text.begin("plab_energy_joules", "gauge", "Energy of the scene.");
    text.add(m.ledger.kinetic, {{"form", "kinetic"}});
    text.add(m.ledger.stored, {{"form", "stored"}});
    text.begin("plab_work_joules", "gauge", "Work on the scene since the run began, by all interactions, and by requests alone.");
    text.add(m.ledger.work, {{"by", "all"}});
    text.add(m.ledger.of_requests, {{"by", "requests"}});
    text.one("plab_energy_error_joules", "gauge", "Kinetic energy that no work explains, since the run began.", m.ledger.unexplained);
}

void add_components(const std::vector<Figures::Component>& components, Text& text)
{
    const auto series = [&](const char* name, const char* help, const auto& value)
    {
        text.begin(name, "gauge", help);
        for (const Figures::Component& c : components)
            if (const double v = value(c); !std::isnan(v)) text.add(v, {{"component", c.id}, {"algorithm", c.algorithm}});
    };
    series("plab_component_cost_seconds", "Processor time in a step, median of the last steps.",
           [](const auto& c) { return c.cost_ns / kNano; });
    series("plab_component_error", "Error as the component declares it, in its own unit; left out where none is known.",
           [](const auto& c) { return c.error; });
    series("plab_component_work_joules", "Work on the scene since the run began.", [](const auto& c) { return c.work; });
    series("plab_component_quarantined", "1 if it was taken out of the run because it failed.",
           [](const auto& c) { return c.quarantined ? 1.0 : 0.0; });
}

}  // namespace

Figures figures_of(const link::CatalogueContents& now)
{
    Figures out;
    if (now.server) out.server = *now.server;
    for (const auto& [id, object] : now.objects) ++(link::is_shaft(object) ? out.shafts : out.bodies);
    out.interactions = now.interactions.size();
    if (!now.metrics) return out;
    const link::Metrics& m = *now.metrics;
    for (const link::InteractionMetrics& i : m.interactions)
    {
        const auto type = now.interactions.find(i.component_id);
        const double error = link::find_account(i, "error") == nullptr ? std::numeric_limits<double>::quiet_NaN() : i.error;
        out.components.push_back({i.component_id, type == now.interactions.end() ? i.requested : type->second.type_name, i.cost_ns, error,
                                  i.work, i.quarantined});
    }
    const std::size_t kept = std::min(out.components.size(), kMostComponents);
    const auto middle = out.components.begin() + static_cast<std::ptrdiff_t>(kept);
    std::partial_sort(out.components.begin(), middle, out.components.end(),
                      [](const auto& a, const auto& b) { return a.cost_ns > b.cost_ns; });
    out.components.resize(kept);
    out.metrics =
        link::Metrics{m.run,      m.revision, m.step,     m.time, m.step_ns, m.real_time_factor, m.ledger, m.momentum, m.angular_momentum,
                      m.residual, m.deepest,  m.contacts, {}};
    return out;
}

std::string metrics_text(const Figures* figures, const PageFigures& pages)
{
    Text text;
    text.one("plab_up", "gauge", "1 while there is a server.", figures != nullptr ? 1 : 0);
    text.one("plab_web_pages", "gauge", "Pages that are open.", static_cast<double>(pages.pages));
    text.one("plab_web_frames_replaced_total", "counter", "Frames that a page did not take before there was a newer one.",
             static_cast<double>(pages.replaced));
    text.one("plab_web_pages_behind_total", "counter", "How often a page took so little that it had to begin anew.",
             static_cast<double>(pages.times_behind));
    if (figures == nullptr) return text.take();
    add_server(figures->server, text);
    add_scene(*figures, text);
    add_components(figures->components, text);
    return text.take();
}

void NewestFigures::set(std::shared_ptr<const Figures> figures)
{
    const std::lock_guard lock(mutex_);
    figures_ = std::move(figures);
}

std::shared_ptr<const Figures> NewestFigures::get() const
{
    const std::lock_guard lock(mutex_);
    return figures_;
}

}  // namespace plab::web
