/// What `watch` and every other stream share: when it ends, and which numbers were missed.
#pragma once

#include <chrono>

#include "control/context.h"

namespace plab::cli
{

/// -n, -d and Ctrl-C.
class Limit
{
public:
    explicit Limit(const Context& context);
    /// One more sample was printed.
    void count() { ++seen_; }
    bool is_reached() const { return (most_ && seen_ >= *most_) || is_over(); }
    bool is_over() const { return end_ && std::chrono::steady_clock::now() >= *end_; }
    /// How long to wait for the next sample: short, so that Ctrl-C is seen.
    link::Seconds slice() const;

private:
    std::optional<std::uint64_t> most_;
    std::optional<std::chrono::steady_clock::time_point> end_;
    std::uint64_t seen_ = 0;
};

/// Watches sequence numbers that have no gaps by promise.
class Numbers
{
public:
    /// Takes `count` samples from `first` on; how many are missing before them. The first call starts; a number that
    /// is too small means that the server started anew.
    std::uint64_t missed_before(std::uint64_t first, std::uint64_t count);
    std::uint64_t missed() const { return missed_; }

private:
    std::optional<std::uint64_t> next_;
    std::uint64_t missed_ = 0;
};

}  // namespace plab::cli
