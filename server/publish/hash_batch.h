/// State hashes of consecutive steps, gathered so that a thousand steps a second are no thousand samples.
#pragma once

#include <optional>
#include <utility>

#include "publish/pace.h"
#include "publish/records.h"

namespace plab::publish
{

class HashBatch
{
public:
    /// A record to hand over, if the new hash completes one or does not follow the last one.
    std::optional<HashRecord> add(std::uint64_t run, Tick step, std::uint64_t hash, Nanoseconds now)
    {
        std::optional<HashRecord> out;
        const auto next = record_.step + static_cast<Tick>(record_.hashes.size());
        if (!record_.hashes.empty() && (record_.run != run || next != step)) out = flush();
        if (record_.hashes.empty()) record_.run = run, record_.step = step, record_.first = next_, since_ = now;
        record_.hashes.push_back(hash), ++next_;
        if (!out && (record_.hashes.size() >= kMost || now - since_ >= kLongest)) out = flush();
        return out;
    }
    /// Whatever has been gathered and waits for long, or in any case.
    std::optional<HashRecord> flush_old(Nanoseconds now) { return now - since_ >= kLongest ? flush() : std::nullopt; }
    std::optional<HashRecord> flush()
    {
        if (record_.hashes.empty()) return {};
        return std::exchange(record_, {});
    }

private:
    static constexpr std::size_t kMost = 64;
    static constexpr Nanoseconds kLongest = 10'000'000;
    HashRecord record_;
    std::uint64_t next_ = 1;
    Nanoseconds since_ = 0;
};

}  // namespace plab::publish
