#include "control/live/metrics_text.h"

#include <cstdlib>

#include "control/console/console.h"

namespace plab::cli
{
namespace
{

std::string text_of(const link::InteractionMetrics& m, std::string_view name)
{
    const link::Parameter* const account = link::find_account(m, name);
    return account != nullptr ? account->text : std::string();
}

}  // namespace

std::string cost_text(const link::InteractionMetrics& m)
{
    if (text_of(m, "cost_steps") == "0") return "-";
    const std::string shared = text_of(m, "cost_shared_by");
    return duration_text(m.cost_ns) + (shared.empty() || shared == "1" ? "" : " (1/" + shared + ")");
}

std::string cost_in_words(const link::InteractionMetrics& m)
{
    const std::string quartiles = text_of(m, "cost_quartiles"), steps = text_of(m, "cost_steps"), shared = text_of(m, "cost_shared_by");
    if (steps == "0") return "not known before the first step";
    std::string out = duration_text(m.cost_ns) + " per step";
    if (const std::size_t blank = quartiles.find(' '); blank != std::string::npos)
        out += ", half of the last " + steps + " steps between " + duration_text(std::strtod(quartiles.c_str(), nullptr)) + " and " +
               duration_text(std::strtod(quartiles.c_str() + blank, nullptr));
    return out + (shared.empty() || shared == "1" ? "" : "; divided evenly, " + shared + " components of its type are measured together");
}

std::string error_text(const link::InteractionMetrics& m) { return link::find_account(m, "no_error") != nullptr ? "-" : number(m.error); }

std::string error_unit(const link::InteractionMetrics& m)
{
    const link::Parameter* const account = link::find_account(m, "error");
    return account != nullptr ? account->unit : std::string();
}

std::string error_meaning(const link::InteractionMetrics& m)
{
    const std::string known = text_of(m, "error");
    return known.empty() ? text_of(m, "no_error") : known;
}

std::string note_text(const std::string& type, const link::InteractionMetrics& m)
{
    if (m.quarantined) return "quarantined";
    if (m.resolved.empty() || m.resolved == type) return {};
    // "TYPE: what about it", or another type that does the work.
    return m.resolved.starts_with(type + ": ") ? m.resolved.substr(type.size() + 2) : "works as " + m.resolved;
}

std::string state_text(const link::ServerInfo& s)
{
    const std::string word = s.playback.empty() ? "running" : "playback";
    if (s.paused) return s.playback.empty() ? "paused" : word + ", paused";
    return s.overload.empty() ? word : s.overload;
}

}  // namespace plab::cli
