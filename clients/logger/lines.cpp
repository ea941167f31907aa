#include "logger/lines.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "idl/samples.h"
#include "link/json.h"
#include "link/text.h"

namespace plab::logger
{
namespace
{

using link::terminal_text;

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

std::string vector(const plab_v2_Vector& v) { return "(" + number(v.x) + " " + number(v.y) + " " + number(v.z) + ")"; }

double length(const plab_v2_Vector& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

/// "    5.0042 s  kind                  "
std::string head(double time, std::string kind)
{
    char text[32];
    std::snprintf(text, sizeof text, "%10.4f s  ", time);
    kind = terminal_text(kind);
    constexpr std::size_t kWidth = 20;
    if (kind.size() < kWidth) kind.resize(kWidth, ' ');
    return text + kind + "  ";
}

std::string note(const std::string& text) { return "-- " + text; }

class HumanLines final : public Lines
{
public:
    std::string event(const plab_v2_Events& sample, std::uint32_t index) const override
    {
        const plab_v2_EventInfo& e = sample.entries._buffer[index];
        std::string line = head(e.time, e.kind);
        const auto add = [&](const std::string& word) { line += word.empty() ? "" : terminal_text(word) + " "; };
        if (severity_is_worth_saying(e.severity)) add(std::string(e.severity) + ":");
        add(e.component_id);
        add(e.a);
        add(e.b);
        if (line.ends_with(' ') && *e.message != 0 && (*e.component_id != 0 || *e.a != 0)) line.back() = ':', line += ' ';
        add(e.message);
        for (std::uint32_t i = 0; i < e.values._length; ++i) line += (i == 0 ? "[" : " ") + number(e.values._buffer[i]);
        line += e.values._length > 0 ? "]" : "";
        while (line.ends_with(' ')) line.pop_back();
        return line;
    }

    std::string collision(const plab_v2_Collisions& sample, std::uint32_t index) const override
    {
        const plab_v2_CollisionInfo& c = sample.entries._buffer[index];
        std::string line = head(c.time, std::string("collision.") + c.kind) + terminal_text(c.a) + " " + terminal_text(c.b);
        if (std::string_view(c.kind) == "end") return line;
        line += "  at " + vector(c.position) + " m";
        if (const double impulse = length(c.impulse); impulse > 0) line += ", impulse " + number(impulse) + " N s";
        if (c.depth > 0) line += ", depth " + number(c.depth) + " m";
        return line;
    }

    std::string metrics(const plab_v2_Metrics& m) const override
    {
        std::string line = head(m.time, "metrics") + "step " + number(m.step_ns * 1e-3) + " us, x" + number(m.real_time_factor) +
                           " of real time, kinetic " + number(m.ledger.kinetic) + " J, unexplained " + number(m.ledger.unexplained) +
                           " J, " + std::to_string(m.contacts) + " contacts, deepest " + number(m.deepest) + " m";
        for (std::uint32_t i = 0; i < m.interactions._length; ++i)
        {
            const plab_v2_InteractionMetrics& one = m.interactions._buffer[i];
            line += "; " + terminal_text(one.component_id) + " " + terminal_text(one.resolved) + " " + number(one.cost_ns) + " ns, error " +
                    number(one.error) + (one.quarantined ? ", quarantined" : "");
        }
        return line;
    }

    std::string status(const plab_v2_Server& s) const override
    {
        std::string line = head(s.time, "status") + "run " + std::to_string(s.run) + ", step " + std::to_string(s.step) + ", revision " +
                           std::to_string(s.revision) + ", x" + number(s.rate_reached) + (s.paused ? ", paused" : "");
        if (*s.overload != 0) line += ", overload: " + terminal_text(s.overload) + ", " + number(s.slipped) + " s of real time lost";
        for (std::uint32_t i = 0; i < s.dropped._length; ++i)
            line += ", " + std::to_string(s.dropped._buffer[i].samples) + " of " + terminal_text(s.dropped._buffer[i].topic) + " dropped";
        return line;
    }

    std::string gap(const Gap& gap) const override
    {
        const bool is_events = std::string_view(gap.topic) == "plab/events";
        return note("missed " + std::to_string(gap.missed) + (is_events ? " event" : " collision") + (gap.missed == 1 ? "" : "s") +
                    " (numbers " + std::to_string(gap.first) + " to " + std::to_string(gap.first + gap.missed - 1) + ")");
    }

    std::string run(std::uint64_t run) const override
    {
        return note("run " + std::to_string(run) + " begins: the scene was loaded or reset");
    }

    std::string server(ServerChange change, const link::ServerInfo& info) const override
    {
        const std::string name = "server '" + terminal_text(info.name) + "'";
        const std::string what = ": process " + std::to_string(info.process) + " on " + terminal_text(info.host) + ", run " +
                                 std::to_string(info.run) + ", scene " + terminal_text(info.scene_file);
        switch (change)
        {
            case ServerChange::Found:
                return note(name + what);
            case ServerChange::Gone:
                return note(name + " has gone; waiting for it to come back");
            case ServerChange::Back:
                return note(name + " is back" + what);
        }
        return {};
    }

private:
    static bool severity_is_worth_saying(std::string_view severity) { return !severity.empty() && severity != "info"; }
};

}  // namespace

std::unique_ptr<Lines> make_human_lines() { return std::make_unique<HumanLines>(); }

// Each line is an object whose "type" is one of event, collision, metrics, status, gap, run, server. The other keys are those
// that plabctl writes with --json.

namespace
{

using link::Json;

/// One line with what all lines begin with, and then the members of `rest`.
std::string line(const char* type, const Json& rest)
{
    Json out{{"type", type}};
    out.update(rest);
    return link::line_of(out);
}

class JsonLines final : public Lines
{
public:
    std::string event(const plab_v2_Events& sample, std::uint32_t index) const override
    {
        return line("event", link::json_of(sample, index));
    }

    std::string collision(const plab_v2_Collisions& sample, std::uint32_t index) const override
    {
        return line("collision", link::json_of(sample, index));
    }

    std::string metrics(const plab_v2_Metrics& sample) const override
    {
        return line("metrics", link::json_of(wire::value_of<link::Metrics>(sample)));
    }

    std::string status(const plab_v2_Server& sample) const override
    {
        return line("status", link::json_of(wire::value_of<link::ServerInfo>(sample)));
    }

    std::string gap(const Gap& gap) const override
    {
        return line("gap", {{"topic", gap.topic}, {"missed", gap.missed}, {"first", gap.first}, {"last", gap.first + gap.missed - 1}});
    }

    std::string run(std::uint64_t run) const override { return line("run", {{"run", run}}); }

    std::string server(ServerChange change, const link::ServerInfo& info) const override
    {
        Json json{{"change", change == ServerChange::Found ? "found" : change == ServerChange::Gone ? "gone" : "back"}};
        json.update(change == ServerChange::Gone ? Json{{"name", info.name}} : link::json_of(info));
        return line("server", json);
    }
};

}  // namespace

std::unique_ptr<Lines> make_json_lines() { return std::make_unique<JsonLines>(); }

}  // namespace plab::logger
