#include "blueprint/template.h"

#include "blueprint/writer.h"

namespace plab::blueprint
{
namespace
{

constexpr std::string_view kBlanks = " \t\r\n";

/// An element as text that begins on the line where it was.
class Text
{
public:
    void put(const XmlElement& e)
    {
        for (; line_ < e.where.line; ++line_) out_ += '\n';
        add("<" + e.name);
        for (const XmlAttribute& a : e.attributes) add(" " + a.name + "=\"" + escape_attribute(a.value) + "\"");
        if (e.children.empty() && e.text.empty()) return add("/>");
        add(">");
        // Blank text between elements would only move them; other text is kept, for the reader to refuse.
        if (e.children.empty() || e.text.find_first_not_of(kBlanks) != std::string::npos) add(escape_text(e.text));
        for (const XmlElement& child : e.children) put(child);
        add("</" + e.name + ">");
    }
    void add(std::string_view text)
    {
        out_ += text;
        for (const char c : text) line_ += c == '\n' ? 1 : 0;
    }
    std::string take() { return std::move(out_); }

private:
    std::string out_;
    std::uint32_t line_ = 1;
};

}  // namespace

Result<std::string> template_text(const XmlElement& element)
{
    Errors errors;
    const auto refuse = [&](const XmlElement& at, std::string why) {
        errors.push_back({{{}, at.where.line, at.where.column}, "<template>", std::move(why)});
    };
    if (!element.attributes.empty()) refuse(element, "takes no attributes");
    if (element.text.find_first_not_of(kBlanks) != std::string::npos) refuse(element, "holds text outside of its component");
    if (element.children.size() != 1 || element.children.front().name != "component")
        refuse(element, "holds one <component>, which may be a group of several");
    if (!errors.empty()) return errors;
    Text text;
    text.add("<plab version=\"1\">"), text.put(element.children.front()), text.add("</plab>");
    return text.take();
}

}  // namespace plab::blueprint
