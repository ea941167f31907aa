/// A block that rocks from one edge to the other: what it keeps of its turning speed at each impact (Housner 1963).
#pragma once

namespace plab::exact
{

/// w'/w, as the angular momentum about the edge that strikes is conserved and nothing rebounds. `gyration2`: J/m about the centre,
/// m^2; half sizes in m.
inline double kept_by_rocking(double gyration2, double half_width, double half_height)
{
    const double b2 = half_width * half_width, h2 = half_height * half_height;
    return (gyration2 + h2 - b2) / (gyration2 + h2 + b2);
}

}  // namespace plab::exact
