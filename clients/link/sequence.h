/// Detects gaps in the sequence numbers of one topic.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace plab::link
{

class Sequence
{
public:
    struct Missing
    {
        std::uint64_t first = 0, count = 0;
    };

    /// A sample with `entries` numbers from `first` on. The very first sample reports no gap: earlier samples do not count as
    /// lost. A new writer continues where the last sample ended (plab-bus was restarted), or starts over (the server was
    /// restarted).
    Missing note(std::uint64_t writer, std::uint64_t first, std::uint64_t entries)
    {
        const auto [known, is_new] = next_.try_emplace(writer, reached_.value_or(first));
        const std::uint64_t expected = known->second;
        known->second = first + entries;
        if (is_new) latest_ = writer;
        if (writer == latest_) reached_ = first + entries;  // a late sample of the previous writer changes nothing
        return first <= expected ? Missing{} : Missing{expected, first - expected};
    }
    /// No more samples come from the previous writers.
    void forget() { next_.clear(), reached_.reset(); }

private:
    std::map<std::uint64_t, std::uint64_t> next_;  ///< by writer
    std::uint64_t latest_ = 0;                     ///< the most recent writer
    std::optional<std::uint64_t> reached_;         ///< the next number of that writer
};

}  // namespace plab::link
