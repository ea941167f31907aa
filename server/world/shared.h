/// A value that copies share until one of them is changed.
#pragma once

#include <memory>

namespace plab::world
{

/// Backups of a world hold its structure this way: a copy costs a pointer, and only a change of structure costs more.
/// Not for use by several threads.
template <class T>
class Shared
{
public:
    Shared() : value_(std::make_shared<T>()) {}

    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_.get(); }
    /// For changes; whoever shares the old value keeps it.
    T& edit()
    {
        if (value_.use_count() > 1) value_ = std::make_shared<T>(*value_);
        return *value_;
    }
    /// Whether both are the same value, unchanged since one was copied from the other.
    bool same_as(const Shared& other) const { return value_ == other.value_; }

private:
    std::shared_ptr<T> value_;
};

}  // namespace plab::world
