/// A copy-on-write value: copies share it until one of them is changed.
#pragma once

#include <memory>
#include <utility>

namespace plab::world
{

/// Backups of a world hold its structure in this way: a copy costs one pointer, and only a change of structure costs more. Not for use by
/// several threads at a time, except for values that were lent; a holder may be handed over to another thread.
template <class T>
class Shared
{
public:
    Shared() : holder_(std::make_shared<Holder>()) {}

    const T& operator*() const { return holder_->value; }
    const T* operator->() const { return &holder_->value; }
    /// Access for changes; other holders keep the old value.
    T& edit()
    {
        // A lent value is always copied: its use count cannot be trusted, because another thread may release it at this moment.
        if (holder_->lent || holder_.use_count() > 1) holder_ = std::make_shared<Holder>(Holder{holder_->value, false});
        return holder_->value;
    }
    /// The present value, for any thread: it will never change again.
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
