// Each line is an object whose "type" is one of event, collision, metrics, status, gap, run, server. The other keys are those
// that plabctl writes with --json.
#include "idl/samples.h"
#include "link/json.h"
#include "logger/lines.h"

namespace plab::logger
{
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
