#include "dense.h"

#include <algorithm>

namespace plab::solvers
{

void multiply(const SquareMatrix<double>& a, const SquareMatrix<double>& b, SquareMatrix<double>& out)
{
    const std::size_t n = a.size();
    out.resize(n);
    std::fill(out.all().begin(), out.all().end(), 0.0);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < n; ++k)
        {
            const double factor = a(i, k);
            if (factor == 0) continue;
            const auto from = b.row(k);
            const auto to = out.row(i);
            for (std::size_t j = 0; j < n; ++j) to[j] += factor * from[j];
        }
}

}  // namespace plab::solvers
