#include "control/command/context.h"

#include "program/interruption.h"

namespace plab::cli
{

bool Context::stopped() const { return program::is_interrupted(); }

Exit Context::join()
{
    auto joined = link::Session::join(settings.link);
    if (!joined) return fail(Exit::Failed, joined.errors());
    session_ = joined.take();
    return Exit::Done;
}

Exit Context::connect(double otherwise)
{
    if (const Exit e = join(); e != Exit::Done) return e;
    if (auto found = session_->find_server(settings.link, timeout(otherwise), stop()); !found) return fail(Exit::NoServer, found.errors());
    return Exit::Done;
}

Exit Context::fail(Exit code, const std::string& message) const
{
    if (stopped()) return Exit::Interrupted;
    console.say(std::string("plabctl: ") + printable(message));
    return code;
}

Exit Context::fail(Exit code, const Errors& errors) const
{
    Exit out = code;
    for (const Error& e : errors) out = fail(code, e.text());
    return out;
}

Command add_command(const Command& app, Context& context, const CommandText& text, Context::Action run)
{
    return app.add_command(text.name, text.doc, "Examples:\n" + text.examples, [&context, run = std::move(run)] { context.action = run; });
}

}  // namespace plab::cli
