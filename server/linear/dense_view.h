/// Eigen views of square matrices. To be included by sources only, because it includes Eigen.
#pragma once

#include "linear/square_matrix.h"
#include "plab/eigen.h"

namespace plab::linear
{

template <class T>
using DenseMatrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
template <class T>
using DenseVector = Eigen::Matrix<T, Eigen::Dynamic, 1>;

template <class T>
Eigen::Map<DenseMatrix<T>> view(SquareMatrix<T>& a)
{
    const auto n = static_cast<Eigen::Index>(a.size());
    return {a.all().data(), n, n};
}
template <class T>
Eigen::Map<const DenseMatrix<T>> view(const SquareMatrix<T>& a)
{
    const auto n = static_cast<Eigen::Index>(a.size());
    return {a.all().data(), n, n};
}

}  // namespace plab::linear
