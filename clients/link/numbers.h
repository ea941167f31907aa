/// Numbers that people give: what is wrong with one, in words; empty if nothing is. All clients refuse the same ones.
#pragma once

#include <string>

namespace plab::link
{

// Real numbers, of seconds and metres: neither endless nor more than kLongestWait.
std::string check_positive(const std::string& text);
std::string check_not_negative(const std::string& text);

// Whole numbers that fit 63 bits.
std::string check_count(const std::string& text);  ///< 1 or more
std::string check_whole(const std::string& text);  ///< 0 or more

}  // namespace plab::link
