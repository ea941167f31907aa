#include "control/live/request.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "control/console/json.h"
#include "control/console/table.h"
#include "link/numbers.h"

namespace plab::cli
{
namespace
{

Exit refused(const Context& context, const link::Reply& reply)
{
    context.console.say("plabctl: " + reply.outcome + " at step " + std::to_string(reply.step) + ":");
    for (const std::string& why : reply.reasons) context.console.say("  " + printable(why));
    if (reply.reasons.empty()) context.console.say("  the server gave no reason");
    return Exit::Refused;
}

/// A request outlives a time-out, but not the server: until it is answered, it may take effect.
std::string outcome_of_unanswered(const Context& context, const link::Caller& caller, const Timing& timing)
{
    const std::string step = timing.at ? "step " + std::to_string(*timing.at) : "its next step";
    const std::string name = caller.last_request();
    if (name.empty()) return "it was not sent";
    const std::string back = "'plabctl --server " + context.session().server() + " cancel " + name + "' cancels it";
    switch (caller.presence())
    {
        case link::Presence::There:
            return (timing.at ? step + " may still be to come: the request remains valid, "
                              : "the request remains valid, and can take effect before " + step + ": ") +
                   std::string("--timeout waits longer, ") + back;
        case link::Presence::Silent:
            return "the server does not respond: if it comes back, the request can still take effect before " + step + "; " + back;
        case link::Presence::Gone:
            break;
    }
    return "the server has gone: if it had not come to " + step + ", the request will not be carried out";
}

}  // namespace

void add_timing(const Command& command, Timing& timing)
{
    command.add_option("--at", timing.at, "take effect before this step; refused if the step is past")
        .check(link::check_whole)
        .type_name("STEP");
    command.add_option("--revision", timing.revision, "refuse unless the scene is at this revision")
        .check(link::check_whole)
        .type_name("N");
}

Exit send(Context& context, std::vector<link::Operation> operations, const Timing& timing)
{
    if (!context.is_connected())
        if (const Exit e = context.connect(); e != Exit::Done) return e;
    auto caller = link::Caller::make(context.session(), context.timeout(), context.stop());
    if (!caller) return context.fail(Exit::NoServer, caller.errors());
    const link::Request request{std::move(operations), timing.at, timing.revision};
    auto reply = caller->call(request, context.timeout(), context.stop());
    if (!reply) return context.fail(Exit::NoServer, reply.error().text() + "; " + outcome_of_unanswered(context, *caller, timing));
    if (context.settings.json)
    {
        Json json{{"server", context.session().server()}};
        json.update(json_of(*reply));
        print(context.console, json);
    }
    else if (reply->done())
        print_reply(context.console, request.operations, *reply);
    if (!reply->done()) return refused(context, *reply);
    return Exit::Done;
}

Result<std::string> read_text(const std::string& file)
{
    std::ifstream opened;
    if (file != "-") opened.open(file, std::ios::binary);
    if (file != "-" && !opened) return reason("cannot open '" + file + "'");
    std::istream& in = file == "-" ? std::cin : opened;
    std::string text(wire::kMostRequestBytes + 1, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    if (in.bad() || (!in.eof() && in.fail())) return reason("cannot read '" + file + "'");
    if (text.size() > wire::kMostRequestBytes)
        return reason("'" + file + "' is larger than a request can be: " + std::to_string(wire::kMostRequestBytes) + " bytes");
    if (text.empty()) return reason("'" + file + "' is empty");
    return text;
}

namespace
{

std::string when(const link::Reply& r) { return "step " + std::to_string(r.step) + " (" + number(r.time) + " s)"; }

std::string past_of(const link::Operation& op)
{
    static constexpr std::array<std::pair<const char*, const char*>, 14> kWords{{
        {"add", "added"},
        {"remove", "removed"},
        {"swap", "swapped"},
        {"set", "set"},
        {"push", "pushed"},
        {"pause", "paused"},
        {"resume", "resumed"},
        {"step", "granted steps:"},
        {"rate", "rate is now"},
        {"reset", "reset"},
        {"load", "loaded"},
        {"dt", "step length is now"},
        {"shutdown", "shutting down"},
        {"cancel", "cancelled"},
    }};
    std::string out = op.verb;
    for (const auto& [verb, past] : kWords)
        if (op.verb == verb) out = past;
    if (op.verb == "set")
        for (const auto& [name, value] : op.values) out += " " + op.target + "." + name + "=" + value;
    else if (!op.target.empty())
        out += " " + op.target;
    if (!op.argument.empty() && op.verb != "swap") out += " " + op.argument;
    return printable(out);
}

/// A line for each transfer, in the order of plab.idl; ones that this version does not know come last.
void print_fields(const Console& console, const link::SwapReport& swap)
{
    std::vector<std::pair<std::string, Style>> transfers{
        {"kept", Style::Green}, {"converted", Style::Yellow}, {"given", Style::Cyan}, {"fresh", Style::Yellow}, {"lost", Style::Red}};
    for (const link::FieldFate& f : swap.fields)
        if (std::none_of(transfers.begin(), transfers.end(), [&](const auto& known) { return known.first == f.fate; }))
            transfers.emplace_back(f.fate, Style::Plain);
    for (const auto& [transfer, style] : transfers)
    {
        std::string names;
        for (const link::FieldFate& f : swap.fields)
            if (f.fate == transfer) names += (names.empty() ? "" : ", ") + printable(f.name);
        if (names.empty()) names = "-";
        const std::string padded = transfer + std::string(transfer.size() < 10 ? 10 - transfer.size() : 1, ' ');
        console.out("  " + console.styled(names == "-" ? Style::Dim : style, padded) + names + "\n");
    }
}

std::string vector_text(const Vec3& v) { return number(v.x) + " " + number(v.y) + " " + number(v.z); }

std::string change_text(const Vec3& a, const Vec3& b) { return number(b.x - a.x) + " " + number(b.y - a.y) + " " + number(b.z - a.z); }

/// The server sends the old component's cost only if it differs from the new one's by more than chance.
void add_cost(Table& table, const link::StepOutcome& old, const link::StepOutcome& now)
{
    const auto text = [](double ns) { return std::isfinite(ns) ? duration_text(ns) : std::string("-"); };
    if (!std::isfinite(now.cost_ns) && !std::isfinite(old.cost_ns)) return;
    const double more = now.cost_ns - old.cost_ns;
    table.add({"cost of the step", text(old.cost_ns), text(now.cost_ns), std::isfinite(more) ? duration_text(more) : "not significant"});
}

void print_swap(const Console& console, const link::SwapReport& swap)
{
    console.out(console.styled(Style::Bold, printable(swap.component_id)) + ": " + printable(swap.from_type) + " -> " +
                console.styled(Style::Bold, printable(swap.to_type)) + "\n");
    print_fields(console, swap);
    const link::StepOutcome &a = swap.with_old, &b = swap.with_new;
    if (std::isnan(b.energy))
    {
        console.out("first step not tried\n");
        return;
    }
    Table table({{"first step"},
                 {"with the old", Align::Right, Shrink::Wrap},
                 {"with the new", Align::Right, Shrink::Wrap},
                 {"difference", Align::Right, Shrink::Wrap}});
    table.add({"energy, J", exact_number(a.energy), exact_number(b.energy), number(b.energy - a.energy)});
    table.add({"momentum, N s", vector_text(a.momentum), vector_text(b.momentum), change_text(a.momentum, b.momentum)});
    table.add({"error", exact_number(a.error), exact_number(b.error), number(b.error - a.error)});
    add_cost(table, a, b);
    table.print(console);
    console.out("energy at the boundary " + exact_number(swap.energy_before) + " J\n");
}

}  // namespace

void print_reply(const Console& console, const std::vector<link::Operation>& operations, const link::Reply& reply)
{
    std::string text;
    for (const link::Operation& op : operations)
        if (op.verb != "trial" && op.verb != "energy") text += (text.empty() ? "" : ", ") + past_of(op);
    console.out(text + " at " + when(reply) + ", revision " + std::to_string(reply.revision) + ", run " + std::to_string(reply.run) +
                ", pause " + duration_text(reply.pause_ns) + "\n");
    if (!reply.trial.empty() && reply.trial != "none") console.out("trial " + printable(reply.trial) + "\n");
    for (const link::SwapReport& swap : reply.swaps) print_swap(console, swap);
}

}  // namespace plab::cli
