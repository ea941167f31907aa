#include "control/stream.h"

#include <algorithm>

namespace plab::cli
{

Limit::Limit(const Context& context) : most_(context.settings.count)
{
    if (context.settings.duration) end_ = link::moment_after(link::Seconds(*context.settings.duration));
}

link::Seconds Limit::slice() const
{
    constexpr link::Seconds kSlice(0.1);
    if (!end_) return kSlice;
    return std::clamp(link::Seconds(*end_ - std::chrono::steady_clock::now()), link::Seconds(0), kSlice);
}

std::uint64_t Numbers::missed_before(std::uint64_t first, std::uint64_t count)
{
    const std::uint64_t missed = next_ && first > *next_ ? first - *next_ : 0;
    next_ = first + count;
    missed_ += missed;
    return missed;
}

}  // namespace plab::cli
