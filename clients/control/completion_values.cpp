#include "control/completion_values.h"

#include <chrono>

#include "completion/server_values.h"
#include "control/live/commands.h"
#include "control/recording/analysis/signal.h"
#include "idl/topics.h"

namespace plab::cli
{
namespace
{

using completion::ids_in;
using completion::snapshot_of;
using program::Candidate;
using program::Values;
using program::Wanted;

constexpr link::Seconds kForFile(0.8);

std::vector<Candidate> ids(const Wanted& wanted, const link::SessionOptions& options)
{
    link::Parts parts = static_cast<link::Parts>(link::Part::Objects);
    if (wanted.command != "push") parts = parts | link::Part::Interactions;
    if (wanted.command == "show") parts = parts | link::Part::Types;
    const link::CatalogueContents now = snapshot_of(options, parts);
    std::vector<Candidate> out = ids_in(now);
    for (const auto& [name, t] : now.types) out.push_back({name, t.doc});
    return out;
}

std::string type_of(const link::CatalogueContents& now, const std::string& id)
{
    if (const auto at = now.interactions.find(id); at != now.interactions.end()) return at->second.type_name;
    if (const auto at = now.objects.find(id); at != now.objects.end()) return at->second.type_name;
    return {};
}

/// Those that can take the place of the component that the line names; all where it names none.
std::vector<Candidate> types(const Wanted& wanted, const link::SessionOptions& options)
{
    const link::CatalogueContents now = snapshot_of(options, link::Part::Objects | link::Part::Interactions | link::Part::Types);
    const auto old = now.types.find(type_of(now, wanted.first("id")));
    std::vector<Candidate> out;
    for (const auto& [name, t] : now.types)
        if (old == now.types.end() || (t.family == old->second.family && name != old->first)) out.push_back({name, t.doc});
    return out;
}

std::vector<Candidate> families(const link::SessionOptions& options)
{
    std::vector<Candidate> out;
    for (const auto& [name, t] : snapshot_of(options, static_cast<link::Parts>(link::Part::Types)).types) out.push_back({t.family, ""});
    return out;
}

/// Fields of a type that a request may write, with `before` in front.
std::vector<Candidate> fields_of(const link::CatalogueContents& now, const std::string& type, const std::string& before)
{
    std::vector<Candidate> out;
    const auto at = now.types.find(type);
    if (at == now.types.end()) return out;
    for (const link::FieldInfo& f : at->second.fields)
        if (f.kind == "param" || f.kind == "state")
            out.push_back({before + f.name + "=", f.doc + (f.unit.empty() ? std::string() : ", " + f.unit)});
    return out;
}

/// "gears" becomes "gears.", and that "gears.velocity_factor=".
Values assignments(const Wanted& wanted, const link::SessionOptions& options)
{
    Values out;
    out.go_on = true;
    const link::CatalogueContents now = snapshot_of(options, link::Part::Objects | link::Part::Interactions | link::Part::Types);
    for (const Candidate& c : ids_in(now))
    {
        const std::string before = c.word + ".";
        if (wanted.begun.starts_with(before))
            for (Candidate& field : fields_of(now, c.help, before)) out.candidates.push_back(std::move(field));
        else
            out.candidates.push_back({before, c.help});
    }
    return out;
}

/// Values of the new component: those of the type behind --to, whose last words may be enough.
Values parameters(const Wanted& wanted, const link::SessionOptions& options)
{
    Values out;
    out.go_on = true;
    const link::CatalogueContents now = snapshot_of(options, link::Part::Objects | link::Part::Interactions | link::Part::Types);
    const std::string to = wanted.first("--to").empty() ? type_of(now, wanted.first("id")) : wanted.first("--to");
    for (const auto& [name, t] : now.types)
        if (name == to || name.ends_with("/" + to)) out.candidates = fields_of(now, name, "");
    return out;
}

std::vector<Candidate> snapshots(const link::SessionOptions& options)
{
    std::vector<Candidate> out;
    const link::CatalogueContents now = snapshot_of(options, static_cast<link::Parts>(link::Part::Server));
    if (!now.server) return out;
    for (const auto& s : now.server->snapshots) out.push_back({s.name, "step " + std::to_string(s.step)});
    return out;
}

/// What is in the recording that the line names.
std::vector<Candidate> quantities(const Wanted& wanted)
{
    const auto end = std::chrono::steady_clock::now() + kForFile;
    const auto log = analysis::Log::open(wanted.first("file"), [end](double) { return std::chrono::steady_clock::now() < end; });
    std::vector<Candidate> out;
    if (!log) return out;
    for (const std::string& name : analysis::signal_names(log->things())) out.push_back({name, ""});
    return out;
}

std::vector<Candidate> topics(bool is_short)
{
    std::vector<Candidate> out;
    for (const wire::Topic& topic : wire::topics())
    {
        const std::string name = topic.name;
        out.push_back({is_short ? name.substr(name.find('/') + 1) : name, topic.doc});
    }
    return out;
}

}  // namespace

program::Values completion_values(const Wanted& wanted, link::SessionOptions options)
{
    completion::limit_time();
    options = completion::options_on(wanted, std::move(options));
    const std::string& value = wanted.value;
    Values out;
    if (wanted.option == "--quantity")
        out.candidates = quantities(wanted);
    else if (wanted.option == "name" && (wanted.command == "restore" || wanted.command == "forget"))
        out.candidates = snapshots(options);
    else if (value == "ID")
        out.candidates = ids(wanted, options);
    else if (value == "TYPE")
        out.candidates = types(wanted, options);
    else if (value == "FAMILY")
        out.candidates = families(options);
    else if (value == "ID.NAME=VALUE")
        return assignments(wanted, options);
    else if (value == "NAME=VALUE")
        return parameters(wanted, options);
    else if (value == "STREAM")
        for (const std::string& name : watch_streams()) out.candidates.push_back({name, ""});
    else if (value.starts_with("TOPIC") || wanted.option == "topic")
        out.candidates = topics(value == "TOPIC");
    else if (value == "RATE")
        out.candidates = {{"real", "as time passes"}, {"max", "as fast as it goes"}};
    else
        return completion::common_values(wanted, options);
    return out;
}

}  // namespace plab::cli
