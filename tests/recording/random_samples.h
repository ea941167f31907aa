/// Samples of any type with random values, as they are on the wire.
#pragma once

#include <random>

#include "idl/recording/records.h"
#include "link/dynamic_sample.h"

namespace plab::test
{

/// A sample of `type` in XCDR1 little-endian with its encapsulation. Lists have 0 to 4 elements; reals are of all sizes,
/// infinities and negative zero among them.
recording::Bytes random_sample(const link::DynamicType& type, std::mt19937_64& random);

}  // namespace plab::test
