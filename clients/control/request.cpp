#include "control/request.h"

#include <fstream>
#include <iostream>

#include "control/json.h"
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

}  // namespace plab::cli
