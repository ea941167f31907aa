#include "viewer/moment_buffer.h"

#include <cmath>

namespace plab::view
{
namespace
{

std::size_t rows_of(const Moment& m) { return m.state.bodies.size() + m.state.shafts.size(); }

}  // namespace

MomentBuffer::MomentBuffer(const Grid& grid, std::size_t most_moments, std::size_t most_rows)
    : grid_(grid), most_moments_(most_moments), most_rows_(most_rows)
{
}

std::int64_t MomentBuffer::cell_of(const State& state) const
{
    return static_cast<std::int64_t>(std::floor((state.time + kSameTime - *grid_.origin) * grid_.per_second));
}

bool MomentBuffer::is_of_no_more_use(const Moment& newest) const
{
    // This one and the newest two are in one cell: the middle one is neither its first nor its last. Moments that change the
    // scene are always kept.
    if (grid_.per_second <= 0 || moments_.size() < 2) return false;
    const Moment& first = moments_[moments_.size() - 2];
    const Moment& middle = moments_.back();
    if (first.state.run != newest.state.run || first.scene != newest.scene) return false;
    return cell_of(first.state) == cell_of(middle.state) && cell_of(middle.state) == cell_of(newest.state);
}

bool MomentBuffer::is_full() const { return moments_.size() >= most_moments_ || (rows_ > most_rows_ && moments_.size() > 2); }

void MomentBuffer::push(Moment&& moment)
{
    {
        const std::lock_guard lock(mutex_);
        if (!grid_.origin) grid_.origin = moment.state.time;
        const bool full = is_full();
        if (full) ++given_up_;
        if (full || is_of_no_more_use(moment))
        {
            rows_ -= rows_of(moments_.back());
            moments_.pop_back();
        }
        rows_ += rows_of(moment);
        moments_.push_back(std::move(moment));
    }
    came_.notify_one();
}

void MomentBuffer::close(std::string why)
{
    {
        const std::lock_guard lock(mutex_);
        if (!closed_) closed_ = std::move(why);
    }
    came_.notify_one();
}

std::optional<Moment> MomentBuffer::pop(link::Seconds timeout)
{
    std::unique_lock lock(mutex_);
    if (!came_.wait_for(lock, timeout, [this] { return !moments_.empty() || closed_; }) || moments_.empty()) return {};
    Moment out = std::move(moments_.front());
    moments_.pop_front();
    rows_ -= rows_of(out);
    return out;
}

std::optional<std::string> MomentBuffer::closed() const
{
    const std::lock_guard lock(mutex_);
    return moments_.empty() ? closed_ : std::nullopt;
}

std::uint64_t MomentBuffer::given_up() const
{
    const std::lock_guard lock(mutex_);
    return given_up_;
}

}  // namespace plab::view
