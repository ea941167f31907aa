/// Text to values and back, with units, dimensions and rules; values as columns of numbers.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "model/scene.h"
#include "plab/schema.h"

namespace plab::model
{

/// Parses `text` for `field`: numbers in SI or with a unit that fits ("30 deg", "5 cm", "60 rpm"), vectors by blanks.
/// Refused: commas, locale decimals, NaN, infinity unless the field may be infinite, trailing text, a unit of another
/// dimension. Applies check_value. The error carries only a reason.
Result<Value> parse_value(std::string_view text, const Field& field);

/// The name of a field in messages: its name, or "the value".
std::string subject_of(const Field& field);

/// Checks type, finiteness and rules of a value made elsewhere; normalises directions and rotations in place.
Result<void> check_value(Value& value, const Field& field);

/// Text that parses back to the same bits (17 significant digits where needed), without unit.
std::string format_value(const Value& value);

// The numbers of a value, and how tables name them: "ball.position" is three columns, .x .y .z.

/// A number, a truth value, the elements of a vector, a rotation (w, x, y, z) or a list; none of texts and of opaque values.
std::size_t number_count(const Value& value);
void append_numbers(const Value& value, std::vector<double>& out);
/// What follows the field's name, one for each number: "" of a single one, ".x", ".2" for the second of a list.
std::vector<std::string> number_suffixes(const Value& value);

/// Parses "1/240", "0.001", "2 ms": exact if possible. Must be positive and finite.
Result<StepLength> parse_step_length(std::string_view text);

}  // namespace plab::model
