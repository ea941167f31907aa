#include "control/work.h"

#include <cstdio>

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

}  // namespace plab::cli
