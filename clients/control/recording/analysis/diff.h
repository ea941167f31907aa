/// Where two recordings of a scene first differ, and how the difference grows.
/// The n-th run of one is compared with the n-th of the other, steps with equal steps, objects with those of the same id.
/// Recordings may have different rates: only steps that both have are compared.
#pragma once

#include <array>

#include "control/recording/analysis/log.h"
#include "figures/chart.h"

namespace plab::analysis
{

struct HashDifference
{
    std::size_t run = 0;  ///< counts from 1 in both
    std::int64_t step = 0;
    std::uint64_t a = 0, b = 0;
};

struct StateDifference
{
    std::size_t run = 0;
    std::int64_t step = 0;
    double time = 0;  ///< s, simulated
    std::string object, quantity;
    double a = 0, b = 0;  ///< SI
};

/// Thresholds for the growth of the difference: m, rad, m/s, rad/s.
inline constexpr std::array<double, 4> kExceeded{1e-12, 1e-9, 1e-6, 1e-3};

/// Of one object. The size of a difference is the largest one of its components, in SI units; an orientation and its negative
/// are the same.
struct Growth
{
    std::string object;
    bool is_shaft = false;
    std::array<std::optional<double>, kExceeded.size()> exceeded;  ///< s on A's time line, when it was first exceeded
    double largest = 0;
    // At the last compared step; for a shaft: angle and speed.
    double position = 0;          ///< m, or rad
    double orientation = 0;       ///< rad, between the two
    double velocity = 0;          ///< m/s, or rad/s
    double angular_velocity = 0;  ///< rad/s
};

/// A run that has no partner in the other recording.
struct SingleRun
{
    std::size_t run = 0;  ///< counts from 1
    bool is_in_a = false;
};

struct Difference
{
    std::size_t runs_a = 0, runs_b = 0;
    std::vector<SingleRun> not_compared;
    std::uint64_t hashes_a = 0, hashes_b = 0, hashes_compared = 0;
    std::optional<HashDifference> first_hash;
    std::uint64_t frames_a = 0, frames_b = 0, frames_compared = 0;
    std::optional<StateDifference> first_state;
    std::vector<Growth> objects;  ///< the largest difference first
    std::vector<std::string> only_in_a, only_in_b;
    Troubles troubles_a, troubles_b;

    bool is_none() const { return !first_hash && !first_state && only_in_a.empty() && only_in_b.empty() && not_compared.empty(); }
    /// Neither hashes nor states have a step in common: nothing is known.
    bool is_unknown() const { return hashes_compared == 0 && frames_compared == 0; }
};

Difference difference_of(const Log& a, const Log& b);

/// The size of the difference of these objects over A's time, logarithmic. Without a difference, there is no line.
figures::Chart difference_chart(const Log& a, const Log& b, const std::vector<std::string>& objects);

}  // namespace plab::analysis
