/// Shared by `watch` and the other streams: when they end, and which numbers were missed.
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
    /// How long to wait for the next sample: short, so that Ctrl-C is noticed.
    link::Seconds slice() const;

private:
    std::optional<std::uint64_t> most_;
    std::optional<std::chrono::steady_clock::time_point> end_;
    std::uint64_t seen_ = 0;
};

/// Checks sequence numbers, which the server assigns without gaps.
class Numbers
{
public:
    /// Takes `count` samples from `first` on; returns how many are missing before them. The first call only starts; a smaller
    /// number means that the server was restarted.
    std::uint64_t missed_before(std::uint64_t first, std::uint64_t count);
    std::uint64_t missed() const { return missed_; }

private:
    std::optional<std::uint64_t> next_;
    std::uint64_t missed_ = 0;
};

}  // namespace plab::cli
