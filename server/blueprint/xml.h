/// XML as the blueprint reader sees it: plain elements with their places, and no further XML features.
/// No DTD, no entities, no processing instructions, UTF-8 only, and a limit on every size. xml.cpp is the only file that uses
/// the parser (expat).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "plab/result.h"

namespace plab::blueprint
{

/// Longest name of an element, attribute or component, in bytes.
inline constexpr std::size_t kLongestName = 200;

/// Line and column start at 1, columns count characters; line 0: no place. `file`: for documents that consist of several, which of them.
struct TextPosition
{
    std::uint32_t line = 0;
    std::uint32_t column = 0;
    std::uint32_t file = 0;
};

struct XmlAttribute
{
    std::string name;
    std::string value;
};

struct XmlElement
{
    std::string name;
    std::vector<XmlAttribute> attributes;
    std::string text;  ///< all character data directly inside, unchanged
    std::vector<XmlElement> children;
    TextPosition where;
    TextPosition text_where;  ///< place of the first non-blank character

    const std::string* find_attribute(std::string_view wanted) const
    {
        for (const XmlAttribute& a : attributes)
            if (a.name == wanted) return &a.value;
        return nullptr;
    }
};

/// Limits of a document. Exceeding one ends the reading with an error that names it.
struct XmlLimits
{
    std::size_t bytes = std::size_t{64} << 20;
    std::size_t depth = 64;
    std::size_t elements = 2'000'000;
    std::size_t attributes = 64;               ///< per element
    std::size_t name = kLongestName;           ///< of elements and attributes
    std::size_t text = std::size_t{16} << 20;  ///< bytes of one element's text or of one attribute's value
};

/// Receives a document piece by piece, so that at most one top-level element is held as a tree.
class XmlSink
{
public:
    virtual ~XmlSink() = default;
    /// The root element: name, attributes and place only. Return false to keep its children in it.
    virtual bool begin(const XmlElement& root) = 0;
    /// A child of the root, complete, in document order.
    virtual void child(XmlElement element) = 0;
    /// The root again, at its end: with its text, and with its children if begin() returned false.
    virtual void end(XmlElement root) = 0;
};

/// Passes the document to `sink`. Errors that do not prevent further reading are added to `errors`; the result is false if
/// reading had to stop early, after the last of `errors`.
bool parse_xml(std::string_view text, const XmlLimits& limits, XmlSink& sink, Errors& errors);

/// <name> for a message.
std::string in_tags(std::string_view name);

}  // namespace plab::blueprint
