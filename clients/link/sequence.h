/// Sequence numbers of one topic: what is missing between two samples.
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

    /// A sample with `entries` numbers from `first` on. The very first one misses nothing: what was before its reader came is no
    /// loss. A new writer goes on where the last sample ended (plab-bus was started again), or begins anew (the server was).
    Missing note(std::uint64_t writer, std::uint64_t first, std::uint64_t entries)
    {
        const auto [known, is_new] = next_.try_emplace(writer, reached_.value_or(first));
        const std::uint64_t expected = known->second;
        known->second = first + entries;
        if (is_new) latest_ = writer;
        if (writer == latest_) reached_ = first + entries;  // a late sample of the one before changes nothing
        return first <= expected ? Missing{} : Missing{expected, first - expected};
    }
    /// Nothing more comes from whoever wrote before.
    void forget() { next_.clear(), reached_.reset(); }

private:
    std::map<std::uint64_t, std::uint64_t> next_;  ///< by writer
    std::uint64_t latest_ = 0;                     ///< the writer that came last
    std::optional<std::uint64_t> reached_;         ///< by it
};

}  // namespace plab::link
