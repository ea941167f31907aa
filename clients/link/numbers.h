/// Checks numbers given by users: returns the error in words, or an empty text. All clients use the same checks.
#pragma once

#include <string>

namespace plab::link
{

// Real numbers, of seconds and metres: finite and at most kLongestWait.
std::string check_positive(const std::string& text);
std::string check_not_negative(const std::string& text);

// Whole numbers that fit 63 bits.
std::string check_count(const std::string& text);  ///< 1 or more
std::string check_whole(const std::string& text);  ///< 0 or more

}  // namespace plab::link
