#include "control/recording/work.h"

#include <cstdio>

#include "link/numbers.h"

namespace plab::cli
{
namespace
{

/// A reader moves back and forth a little; a new pass starts at the beginning.
constexpr double kNewPass = 0.5;

}  // namespace

Work::Work(const Context& context, std::string what, bool streams)
    : context_(&context),
      progress_(streams && context.console.is_terminal() ? program::ProgressTo::Nowhere : context.progress_to()),
      what_(printable(std::move(what)))
{
}

recording::Watch Work::watch()
{
    return [this](double share)
    {
        if (share < share_ - kNewPass) ++pass_;
        share_ = share;
        // The number of passes is not known in advance, so no remaining time is shown.
        if (progress_.is_due())
            progress_.show(what_ + (pass_ > 1 ? ", pass " + std::to_string(pass_) : "") + "  " + program::bar(share, 30) +
                           "  (Ctrl-C ends)");
        return !context_->stopped();
    };
}

Exit Work::interrupted(const std::string& consequence)
{
    progress_.clear();
    char percent[16];
    std::snprintf(percent, sizeof percent, "%.0f %%", 100 * share_);
    context_->console.say("plabctl: interrupted: " + what_ + " was at " + percent + " of the file" +
                          (pass_ > 1 ? ", pass " + std::to_string(pass_) : "") + "; " + printable(consequence));
    return Exit::Interrupted;
}

void add_file(const Command& command, std::string& file)
{
    command.add_option("file", file, "recording (MCAP)").required().type_name("FILE");
}

void add_span(const Command& command, analysis::Span& span)
{
    constexpr const char* kLine = ": simulated seconds since the start of the recording; a reset does not restart this time";
    command.add_option("--from", span.from, std::string("start at this time") + kLine).check(link::check_not_negative).type_name("SECONDS");
    command.add_option("--to", span.to, "end at this time").check(link::check_not_negative).type_name("SECONDS");
}

/// Errors that did not prevent reading the rest.
Exit warn(const Context& c, const analysis::Troubles& troubles)
{
    for (const std::string& text : troubles.texts) c.console.say("plabctl: " + printable(text));
    if (troubles.count > troubles.texts.size())
        c.console.say("plabctl: and " + std::to_string(troubles.count - troubles.texts.size()) + " more like these");
    return troubles.count == 0 ? Exit::Done : Exit::Failed;
}

}  // namespace plab::cli
