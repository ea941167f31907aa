/// State hashes of consecutive steps, gathered so that a thousand steps per second do not become a thousand samples. None waits
/// here for longer than 3 ms, as long as steps keep their pace.
#pragma once

#include <optional>
#include <utility>

#include "plab/context.h"
#include "publish/pace.h"
#include "publish/records.h"

namespace plab::publish
{

class HashBatch
{
public:
    /// A complete record to hand over, if the new hash completes one or does not follow the last one.
    std::optional<wire::Hashes> add(std::uint64_t run, Tick step, std::uint64_t hash, Nanoseconds now)
    {
        std::optional<wire::Hashes> out;
        const auto next = record_.step + static_cast<Tick>(record_.values.size());
        if (!record_.values.empty() && (record_.run != run || next != step)) out = flush();
        if (record_.values.empty()) record_.run = run, record_.step = step, record_.sequence_number = next_, since_ = now;
        record_.values.push_back(hash), ++next_;
        // The next hash is one step away: the first of these would have to wait for it.
        const Nanoseconds step_time = now - std::exchange(last_, now);
        if (!out && (record_.values.size() >= kMost || now - since_ + step_time > kLongest)) out = flush();
        return out;
    }
    /// The gathered hashes, if they have waited for long, or unconditionally.
    std::optional<wire::Hashes> flush_old(Nanoseconds now) { return now - since_ >= kLongest ? flush() : std::nullopt; }
    std::optional<wire::Hashes> flush()
    {
        if (record_.values.empty()) return {};
        return std::exchange(record_, {});
    }

private:
    static constexpr std::size_t kMost = 64;
    static constexpr Nanoseconds kLongest = 3'000'000;
    wire::Hashes record_;
    std::uint64_t next_ = 1;
    Nanoseconds since_ = 0;  ///< time of the first of them
    Nanoseconds last_ = 0;
};

}  // namespace plab::publish
