/// The numbers of a value, and how tables name them: "ball.position" is three columns, .x .y .z.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "plab/schema.h"

namespace plab::model
{

/// A number, a truth value, the elements of a vector, a rotation (w, x, y, z) or a list; none of texts and of opaque values.
std::size_t number_count(const Value& value);
void append_numbers(const Value& value, std::vector<double>& out);
/// What follows the field's name, one for each number: "" of a single one, ".x", ".2" for the second of a list.
std::vector<std::string> number_suffixes(const Value& value);

}  // namespace plab::model
