/// A value that copies share until one of them is changed.
#pragma once

#include <memory>
#include <utility>

namespace plab::world
{

/// Backups of a world hold its structure this way: a copy costs a pointer, and only a change of structure costs more.
/// Not for use by several threads; what is lent may be.
template <class T>
class Shared
{
public:
    Shared() : holder_(std::make_shared<Holder>()) {}

    const T& operator*() const { return holder_->value; }
    const T* operator->() const { return &holder_->value; }
    /// For changes; whoever shares the old value keeps it.
    T& edit()
    {
        // Who else holds a lent value is not looked at: another thread may let go of it at this moment.
        if (holder_->lent || holder_.use_count() > 1) holder_ = std::make_shared<Holder>(Holder{holder_->value, false});
        return holder_->value;
    }
    /// The present value, for any thread: it never changes again.
    std::shared_ptr<const T> lend() const
    {
        holder_->lent = true;
        return {holder_, &holder_->value};
    }
    /// Whether both are the same value, unchanged since one was copied from the other.
    bool same_as(const Shared& other) const { return holder_ == other.holder_; }

private:
    struct Holder
    {
        T value;
        bool lent = false;
    };
    std::shared_ptr<Holder> holder_;
};

}  // namespace plab::world
