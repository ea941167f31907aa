/// Text as XML writes it.
#pragma once

#include <string>
#include <string_view>

namespace plab
{

/// `text` for an XML document, between quotes of either kind or between tags: what XML reads otherwise is written as an entity, blanks
/// of other kinds than ' ' too, since XML replaces them in attributes. Control characters, which XML does not have, become U+FFFD.
inline std::string xml_text(std::string_view text)
{
    std::string out;
    for (const char c : text) switch (c)
        {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\'':
                out += "&#39;";
                break;
            case '\t':
                out += "&#9;";
                break;
            case '\n':
                out += "&#10;";
                break;
            case '\r':
                out += "&#13;";
                break;
            default:
                if (static_cast<unsigned char>(c) < 0x20)
                    out += "\xEF\xBF\xBD";
                else
                    out += c;
        }
    return out;
}

}  // namespace plab
