/// Small text helpers that the parts of this folder share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plab/result.h"

namespace plab::model
{

/// Space, tab, line feed, carriage return: the separators of words in a blueprint.
constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
constexpr bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
constexpr bool is_letter(char c) { return is_lower(c) || is_upper(c); }
constexpr char to_lower(char c) { return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c; }

std::string_view trimmed(std::string_view text);
std::vector<std::string_view> split_words(std::string_view text);
bool equal_ignoring_case(std::string_view a, std::string_view b);

/// The text in quotes, shortened if it is too long for a message, with control characters replaced by question marks.
std::string quoted(std::string_view text);
/// "'a', 'b' and 'c'" with the given last conjunction; at most `most` of them, then "...".
std::string quoted_list(const std::vector<std::string>& names, std::string_view last_word = "and", std::size_t most = 12);
/// "scene.xml:4:7", or as much of it as is known.
std::string place_text(const SourceLocation& where);

}  // namespace plab::model
