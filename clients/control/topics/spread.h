/// Minimum, maximum, mean and standard deviation of numbers that arrive one by one: of periods and sizes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace plab::cli
{

class Spread
{
public:
    void add(double x)
    {
        least_ = count_ == 0 ? x : std::min(least_, x);
        most_ = count_ == 0 ? x : std::max(most_, x);
        ++count_;
        // Welford's algorithm: avoids the difference of large sums.
        const double off = x - mean_;
        mean_ += off / static_cast<double>(count_);
        squares_ += off * (x - mean_);
    }

    std::uint64_t count() const { return count_; }
    double least() const { return least_; }
    double most() const { return most_; }
    double mean() const { return mean_; }
    double deviation() const { return count_ < 2 ? 0 : std::sqrt(squares_ / static_cast<double>(count_ - 1)); }

private:
    std::uint64_t count_ = 0;
    double least_ = 0, most_ = 0, mean_ = 0, squares_ = 0;
};

}  // namespace plab::cli
