/// Names as ROS 2 allows them.
#pragma once

#include <string>
#include <string_view>

namespace plab::wire::ros
{

/// Letters, digits and '_', and no digit at the beginning: a part of a name.
inline bool is_token(std::string_view text)
{
    constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_", kDigits = "0123456789";
    const bool is_plain = text.find_first_not_of(std::string(kLetters) + std::string(kDigits)) == std::string_view::npos;
    return !text.empty() && is_plain && kDigits.find(text.front()) == std::string_view::npos && text.find("__") == std::string_view::npos;
}

/// Whether topics can have this namespace: tokens with '/' between them, and perhaps one in front; "" is the global one. The names of
/// topics must remain shorter than DDS allows (255 characters).
inline bool is_namespace(std::string_view text)
{
    constexpr std::size_t kLongest = 150;
    if (text.size() > kLongest) return false;
    if (text.starts_with('/')) text.remove_prefix(1);
    while (!text.empty())
    {
        const std::size_t end = text.find('/');
        if (!is_token(text.substr(0, end))) return false;
        if (end == std::string_view::npos) return true;
        text.remove_prefix(end + 1);
        if (text.empty()) return false;
    }
    return true;
}

/// "", or the namespace with '/' in front.
inline std::string normal_namespace(std::string_view text)
{
    if (text.empty() || text == "/") return {};
    return text.starts_with('/') ? std::string(text) : "/" + std::string(text);
}

/// The name of a node for any text: '_' for what a token cannot have.
inline std::string token_of(std::string_view text)
{
    std::string out;
    for (const char c : text)
    {
        const bool is_fine = is_token(std::string_view(&c, 1)) || (c >= '0' && c <= '9');
        // Two '_' in a row are reserved.
        if (is_fine && !(c == '_' && out.ends_with('_')))
            out += c;
        else if (!is_fine && !out.ends_with('_'))
            out += '_';
    }
    return is_token(out) ? out : "n" + out;
}

}  // namespace plab::wire::ros
