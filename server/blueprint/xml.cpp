#include "blueprint/xml.h"

#include <expat.h>

#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "model/text.h"

namespace plab::blueprint
{
namespace
{

struct ParserDeleter
{
    void operator()(XML_Parser p) const { XML_ParserFree(p); }
};
using Parser = std::unique_ptr<std::remove_pointer_t<XML_Parser>, ParserDeleter>;

Error error_at(TextPosition where, std::string element, std::string why)
{
    return Error{{{}, where.line, where.column}, std::move(element), std::move(why)};
}

TextPosition place_of(std::string_view text, std::size_t offset)
{
    TextPosition at{1, 1};
    for (const char c : text.substr(0, offset))
    {
        if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) ++at.column;
        if (c == '\n') ++at.line, at.column = 1;
    }
    return at;
}

/// Length in bytes of the UTF-8 sequence at the start of `s`; 0 if it is invalid (RFC 3629, table 3-7 of the Unicode standard).
std::size_t utf8_length(std::string_view s)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(i < s.size() ? s[i] : '\0'); };
    const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0) == 0x80; };
    const unsigned char a = byte(0), b = byte(1);
    if (a < 0x80) return 1;
    if (a >= 0xC2 && a <= 0xDF) return follows(1) ? 2 : 0;
    if (a >= 0xE0 && a <= 0xEF)
    {
        const bool overlong = a == 0xE0 && b < 0xA0, surrogate = a == 0xED && b > 0x9F;
        return follows(1) && follows(2) && !overlong && !surrogate ? 3 : 0;
    }
    if (a >= 0xF0 && a <= 0xF4)
    {
        const bool overlong = a == 0xF0 && b < 0x90, beyond = a == 0xF4 && b > 0x8F;
        return follows(1) && follows(2) && follows(3) && !overlong && !beyond ? 4 : 0;
    }
    return 0;
}

/// The first byte that is not allowed in a UTF-8 XML document. Found before parsing, because the parser would take a
/// document with NULs or a UTF-16 mark for another encoding.
std::optional<Error> check_encoding(std::string_view text)
{
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        return error_at({1, 1}, {}, "the text is UTF-16; a blueprint must be UTF-8");
    TextPosition at{1, 1};
    for (std::size_t i = 0; i < text.size();)
    {
        const std::size_t n = utf8_length(text.substr(i));
        if (n == 0) return error_at(at, {}, "the text is not valid UTF-8");
        if (text[i] == '\0') return error_at(at, {}, "a NUL character is not allowed in XML");
        ++at.column;
        if (text[i] == '\n') ++at.line, at.column = 1;
        i += n;
    }
    return {};
}

/// Expat's callbacks as members, and the elements that are open.
class Reading
{
public:
    Reading(const XmlLimits& limits, XmlSink& sink, Errors& errors)
        : limits_(limits), sink_(sink), errors_(errors), parser_(XML_ParserCreate("UTF-8"))
    {
        XML_SetUserData(parser_.get(), this);
        XML_SetElementHandler(parser_.get(), &on_start, &on_end);
        XML_SetCharacterDataHandler(parser_.get(), &on_text);
        XML_SetProcessingInstructionHandler(parser_.get(), &on_instruction);
        XML_SetStartDoctypeDeclHandler(parser_.get(), &on_doctype);
        XML_SetXmlDeclHandler(parser_.get(), &on_declaration);
    }

    bool run(std::string_view text)
    {
        text_ = text;
        if (XML_Parse(parser_.get(), text.data(), static_cast<int>(text.size()), XML_TRUE) == XML_STATUS_OK) return true;
        if (!stopped_) errors_.push_back(error_at(place(), {}, "not well-formed XML: " + parser_complaint()));
        return false;
    }

private:
    static Reading& self(void* data) { return *static_cast<Reading*>(data); }
    static void on_start(void* d, const XML_Char* name, const XML_Char** attributes) { self(d).start(name, attributes); }
    static void on_end(void* d, const XML_Char*) { self(d).finish(); }
    static void on_text(void* d, const XML_Char* s, int n) { self(d).add_text({s, static_cast<std::size_t>(n)}); }
    static void on_instruction(void* d, const XML_Char* target, const XML_Char*) { self(d).instruction(target); }
    static void on_doctype(void* d, const XML_Char*, const XML_Char*, const XML_Char*, int) { self(d).doctype(); }
    static void on_declaration(void* d, const XML_Char*, const XML_Char* encoding, int) { self(d).declaration(encoding); }

    TextPosition place() const
    {
        return {static_cast<std::uint32_t>(XML_GetCurrentLineNumber(parser_.get())),
                static_cast<std::uint32_t>(XML_GetCurrentColumnNumber(parser_.get())) + 1};
    }

    void stop(std::string element, std::string why) { stop_at(place(), std::move(element), std::move(why)); }
    void stop_at(TextPosition where, std::string element, std::string why)
    {
        if (stopped_) return;
        stopped_ = true;
        errors_.push_back(error_at(where, std::move(element), std::move(why)));
        XML_StopParser(parser_.get(), XML_FALSE);
    }

    std::string parser_complaint() const
    {
        const XML_Error code = XML_GetErrorCode(parser_.get());
        const std::string open = open_.empty() ? "" : " of line " + std::to_string(open_.back().where.line);
        switch (code)
        {
            case XML_ERROR_NO_ELEMENTS:
                if (open_.empty()) return "the document has no elements";
                return in_tags(open_.back().name) + open + " is never closed";
            case XML_ERROR_TAG_MISMATCH:
                return "a closing tag that does not match the open " + in_tags(open_.back().name) + open;
            case XML_ERROR_UNDEFINED_ENTITY:
                return "unknown entity; only &lt; &gt; &amp; &quot; &apos; and character numbers are known";
            case XML_ERROR_JUNK_AFTER_DOC_ELEMENT:
                return "there is content after the root element";
            default:
                return XML_ErrorString(code);
        }
    }

    void instruction(std::string_view target)
    {
        if (stopped_) return;
        errors_.push_back(error_at(place(), "<?" + std::string(target.substr(0, 40)) + "?>", "processing instructions are not supported"));
        if (++instructions_ >= kMostInstructions) stop({}, "too many processing instructions");
    }

    void doctype()
    {
        // The parser calls this after it has read the name; the reported place is where the declaration begins.
        const auto read = static_cast<std::size_t>(XML_GetCurrentByteIndex(parser_.get()));
        const std::size_t begin = text_.rfind("<!DOCTYPE", read);
        stop_at(begin == text_.npos ? place() : place_of(text_, begin), "DOCTYPE",
                "a document type (DTD) is not supported: a blueprint has no entities");
    }

    void declaration(const XML_Char* encoding)
    {
        if (!encoding) return;
        const std::string_view e = encoding;
        const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
        constexpr std::string_view wanted = "utf-8";
        bool same = e.size() == wanted.size();
        for (std::size_t i = 0; same && i < e.size(); ++i) same = lower(e[i]) == wanted[i];
        if (!same) stop("<?xml?>", "encoding " + model::quoted(e) + " is not supported; a blueprint must be UTF-8");
    }

    bool within_limits(std::string_view name, const XML_Char** attributes)
    {
        if (++elements_ > limits_.elements) return stop({}, "more than " + std::to_string(limits_.elements) + " elements"), false;
        if (name.size() > limits_.name)
            return stop({}, "the name of an element has " + std::to_string(name.size()) + " characters; at most " +
                                std::to_string(limits_.name) + " are allowed"),
                   false;
        if (open_.size() >= limits_.depth)
            return stop(in_tags(name), "elements are nested more than " + std::to_string(limits_.depth) + " deep"), false;
        std::size_t n = 0;
        for (; attributes[2 * n]; ++n)
        {
            if (n >= limits_.attributes)
                return stop(in_tags(name), "more than " + std::to_string(limits_.attributes) + " attributes"), false;
            if (std::strlen(attributes[2 * n]) > limits_.name)
                return stop(in_tags(name), "the name of an attribute has more than " + std::to_string(limits_.name) + " characters"), false;
            if (std::strlen(attributes[2 * n + 1]) > limits_.text)
                return stop(in_tags(name), "the value of attribute " + model::quoted(attributes[2 * n]) + " is longer than " +
                                               std::to_string(limits_.text) + " bytes"),
                       false;
        }
        return true;
    }

    void start(std::string_view name, const XML_Char** attributes)
    {
        if (stopped_ || !within_limits(name, attributes)) return;
        XmlElement e;
        e.name = name, e.where = place();
        for (std::size_t i = 0; attributes[i]; i += 2) e.attributes.push_back({attributes[i], attributes[i + 1]});
        if (open_.empty()) streams_ = sink_.begin(e);
        open_.push_back(std::move(e));
    }

    void add_text(std::string_view s)
    {
        if (stopped_ || open_.empty()) return;
        XmlElement& e = open_.back();
        if (e.text.size() + s.size() > limits_.text)
            return stop(in_tags(e.name), "the text is longer than " + std::to_string(limits_.text) + " bytes");
        std::size_t first = 0;
        while (first < s.size() && model::is_blank(s[first])) ++first;
        if (first < s.size() && e.text_where.line == 0)
        {
            // A run of character data never extends past a line end, so spaces before the text are on its line.
            e.text_where = place();
            e.text_where.column += static_cast<std::uint32_t>(first);
        }
        e.text += s;
    }

    void finish()
    {
        if (stopped_) return;
        XmlElement done = std::move(open_.back());
        open_.pop_back();
        if (open_.empty())
            sink_.end(std::move(done));
        else if (open_.size() == 1 && streams_)
            sink_.child(std::move(done));
        else
            open_.back().children.push_back(std::move(done));
    }

    static constexpr std::size_t kMostInstructions = 100;

    const XmlLimits& limits_;
    XmlSink& sink_;
    Errors& errors_;
    Parser parser_;
    std::string_view text_;
    std::vector<XmlElement> open_;
    std::size_t elements_ = 0;
    std::size_t instructions_ = 0;
    bool streams_ = true;
    bool stopped_ = false;
};

}  // namespace

bool parse_xml(std::string_view text, const XmlLimits& limits, XmlSink& sink, Errors& errors)
{
    if (text.size() > limits.bytes)
    {
        errors.push_back(error_at({}, {}, "the text is larger than " + std::to_string(limits.bytes) + " bytes"));
        return false;
    }
    if (auto bad = check_encoding(text))
    {
        errors.push_back(*std::move(bad));
        return false;
    }
    return Reading(limits, sink, errors).run(text);
}

std::string in_tags(std::string_view name) { return "<" + std::string(name) + ">"; }

}  // namespace plab::blueprint
