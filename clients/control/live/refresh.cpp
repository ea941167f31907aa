#include "control/live/refresh.h"

#include <algorithm>
#include <chrono>

namespace plab::cli
{
namespace
{

/// Takes what arrives until then; short waits, so that Ctrl-C is noticed.
void update_until(const Context& context, link::Catalogue& catalogue, std::chrono::steady_clock::time_point end)
{
    constexpr link::Seconds kSlice(0.1);
    for (auto now = std::chrono::steady_clock::now(); now < end; now = std::chrono::steady_clock::now())
    {
        if (context.stopped() || catalogue.server_is_gone()) return;
        (void)catalogue.wait(std::min(kSlice, link::Seconds(end - now)));
    }
}

}  // namespace

Exit print_again(const Context& context, link::Catalogue& catalogue, link::Seconds every, bool again,
                 const std::function<void(const link::CatalogueContents&)>& print)
{
    const Settings& settings = context.settings;
    const auto begin = std::chrono::steady_clock::now();
    for (std::uint64_t n = 1;; ++n)
    {
        print(catalogue.now());
        if (!context.console.flush()) return Exit::Done;  // the reader is gone: `| head` has enough
        const auto next = begin + std::chrono::duration_cast<std::chrono::steady_clock::duration>(static_cast<double>(n) * every);
        const bool counted = settings.count && n >= *settings.count;
        const bool over = settings.duration && next - begin > link::Seconds(*settings.duration);
        if (!again || counted || over) return Exit::Done;
        update_until(context, catalogue, next);
        if (context.stopped()) return Exit::Interrupted;
        if (catalogue.server_is_gone()) return context.fail(Exit::NoServer, "server '" + context.session().server() + "' has gone");
    }
}

}  // namespace plab::cli
