#include "link/text.h"

#include <array>
#include <charconv>
#include <cstdint>

namespace plab::link
{
namespace
{

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

/// Length of the well-formed UTF-8 sequence at the beginning; 0: there is none.
std::size_t sequence_length(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const auto follows = [&](std::size_t i) { return i < text.size() && (byte(i) & 0xC0) == 0x80; };
    const std::uint8_t first = byte(0);
    if (first < 0x80) return 1;
    if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
    // The second byte distinguishes overlong forms, surrogates, and what is beyond U+10FFFF.
    if (first >= 0xE0 && first <= 0xEF)
    {
        if (!follows(1) || !follows(2)) return 0;
        return (first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F) ? 0 : 3;
    }
    if (first >= 0xF0 && first <= 0xF4)
    {
        if (!follows(1) || !follows(2) || !follows(3)) return 0;
        return (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F) ? 0 : 4;
    }
    return 0;
}

/// Hands each character, and the replacement for each byte that belongs to none, to `put`.
template <class Put>
void each_character(std::string_view text, Put&& put)
{
    while (!text.empty())
    {
        const std::size_t n = sequence_length(text);
        put(n == 0 ? kReplacement : text.substr(0, n));
        text.remove_prefix(n == 0 ? 1 : n);
    }
}

std::string hex(std::string_view prefix, unsigned value, int digits)
{
    std::string out(prefix);
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) out += "0123456789abcdef"[(value >> shift) & 15u];
    return out;
}

/// U+0000 to U+001F, U+007F, and U+0080 to U+009F, which some terminals obey as well.
bool is_control(std::string_view character, unsigned& code)
{
    code = static_cast<std::uint8_t>(character[0]);
    if (character.size() == 2) code = (code & 0x1Fu) << 6 | (static_cast<std::uint8_t>(character[1]) & 0x3Fu);
    return character.size() <= 2 && (code < 0x20 || (code >= 0x7F && code < 0xA0));
}

}  // namespace

std::string number_text(float value)
{
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string terminal_text(std::string_view text)
{
    std::string out;
    each_character(text,
                   [&](std::string_view c)
                   {
                       unsigned code = 0;
                       if (!is_control(c, code))
                           out += c;
                       else if (code == '\n')
                           out += "\\n";
                       else if (code == '\t')
                           out += "\\t";
                       else
                           out += hex("\\x", code, 2);
                   });
    return out;
}

}  // namespace plab::link
