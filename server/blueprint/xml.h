/// XML as the blueprint reader sees it: plain elements with their places, and nothing that XML can do beyond that.
///
/// No DTD, no entities, no processing instructions, UTF-8 only, and a limit on every size. xml.cpp is the only file
/// that knows the parser (expat).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "plab/result.h"

namespace plab::blueprint
{

/// Characters (bytes) of an element's, attribute's or component's name.
inline constexpr std::size_t kLongestName = 200;

/// Line and column from 1, columns in characters; line 0: nowhere.
struct Place
{
    std::uint32_t line = 0;
    std::uint32_t column = 0;
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
    std::string text;  ///< all character data directly inside, as written
    std::vector<XmlElement> children;
    Place where;
    Place text_where;  ///< the first character that is not blank

    const std::string* find_attribute(std::string_view wanted) const
    {
        for (const XmlAttribute& a : attributes)
            if (a.name == wanted) return &a.value;
        return nullptr;
    }
};

/// What a document may need at most. Going past one ends the reading with an error that names it.
struct XmlLimits
{
    std::size_t bytes = std::size_t{64} << 20;
    std::size_t depth = 64;
    std::size_t elements = 2'000'000;
    std::size_t attributes = 64;               ///< per element
    std::size_t name = kLongestName;           ///< of elements and attributes
    std::size_t text = std::size_t{16} << 20;  ///< bytes of one element's text or of one attribute's value
};

/// Receives a document piece by piece, so that no more than one element of the top level is held as a tree.
class XmlSink
{
public:
    virtual ~XmlSink() = default;
    /// The root element: name, attributes and place only. False if its children should be kept in it instead.
    virtual bool begin(const XmlElement& root) = 0;
    /// A child of the root, complete, in document order.
    virtual void child(XmlElement element) = 0;
    /// The root again, at its end: with its text, and with its children if begin() said false.
    virtual void end(XmlElement root) = 0;
};

/// Feeds `sink`. Errors of form that do not hide what follows are added to `errors`; the result is false when reading
/// had to stop early, after the last of `errors`.
bool parse_xml(std::string_view text, const XmlLimits& limits, XmlSink& sink, Errors& errors);

/// <name> for a message.
std::string in_tags(std::string_view name);

}  // namespace plab::blueprint
