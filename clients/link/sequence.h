/// Sequence numbers of one topic: what is missing between two samples of one writer.
#pragma once

#include <cstdint>
#include <map>

namespace plab::link
{

class Sequence
{
public:
    struct Missing
    {
        std::uint64_t first = 0, count = 0;
    };

    /// A sample with `entries` numbers from `first` on. The first one of a writer misses nothing: what was before its
    /// reader came is no loss. A server that was started again is another writer.
    Missing note(std::uint64_t writer, std::uint64_t first, std::uint64_t entries)
    {
        const auto [known, is_new] = next_.try_emplace(writer, first);
        const std::uint64_t expected = known->second;
        known->second = first + entries;
        return is_new || first <= expected ? Missing{} : Missing{expected, first - expected};
    }
    /// Nothing more comes from whoever wrote before.
    void forget() { next_.clear(); }

private:
    std::map<std::uint64_t, std::uint64_t> next_;  ///< by writer
};

}  // namespace plab::link
