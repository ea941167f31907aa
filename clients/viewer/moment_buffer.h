/// States on their way from the reading thread to the drawing thread. Bounded: if drawing is slower than the server's steps,
/// states in between are dropped instead of using more memory.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>

#include "link/catalogue.h"
#include "viewer/state.h"

namespace plab::view
{

/// A state, and the scene as it was known then.
struct Moment
{
    State state;
    std::shared_ptr<const link::CatalogueContents> scene;
};

/// Of the states between two times of a regular grid, only the first and the last are needed.
struct Grid
{
    double per_second = 0;         ///< 0: every state is needed
    std::optional<double> origin;  ///< s; none: the first state's time
};

class MomentBuffer
{
public:
    static constexpr std::size_t kMostMoments = 1024;
    static constexpr std::size_t kMostRows = 4u << 20;  ///< bodies and shafts of all moments together: 256 MB

    explicit MomentBuffer(const Grid& grid, std::size_t most_moments = kMostMoments, std::size_t most_rows = kMostRows);

    /// If the buffer is full, this moment replaces the previous one.
    void push(Moment&& moment);
    /// No more moments will follow, for this reason.
    void close(std::string why);

    /// The oldest moment; empty if none arrived until `timeout`, or after the last one of a closed buffer.
    std::optional<Moment> pop(link::Seconds timeout);
    /// Why it was closed, once all moments are taken.
    std::optional<std::string> closed() const;
    /// Moments that were dropped because it was full.
    std::uint64_t given_up() const;

private:
    std::int64_t cell_of(const State& state) const;
    bool is_of_no_more_use(const Moment& newest) const;
    bool is_full() const;

    mutable std::mutex mutex_;
    std::condition_variable came_;
    Grid grid_;
    std::size_t most_moments_, most_rows_, rows_ = 0;
    std::deque<Moment> moments_;
    std::optional<std::string> closed_;
    std::uint64_t given_up_ = 0;
};

}  // namespace plab::view
