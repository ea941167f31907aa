/// Storage of a dense matrix.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace plab::linear
{

/// An n x n matrix, column-major. Keeps its memory when it is resized.
template <class T>
class SquareMatrix
{
public:
    void resize(std::size_t n) { n_ = n, a_.resize(n * n); }
    std::size_t size() const { return n_; }
    T& operator()(std::size_t r, std::size_t c) { return a_[c * n_ + r]; }
    const T& operator()(std::size_t r, std::size_t c) const { return a_[c * n_ + r]; }
    std::span<T> all() { return a_; }
    std::span<const T> all() const { return a_; }

private:
    std::size_t n_ = 0;
    std::vector<T> a_;
};

}  // namespace plab::linear
