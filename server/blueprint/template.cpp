#include "blueprint/template.h"

#include "blueprint/reader.h"
#include "blueprint/writer.h"
#include "blueprint/xgl.h"

namespace plab::blueprint
{
namespace
{

constexpr std::string_view kOpen = "<plab version=\"1\">", kClose = "</plab>";

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
        // Where there are elements, the text between them is blank: it would only move them.
        if (e.children.empty()) add(escape_text(e.text));
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

/// The content of a text made above; empty if it is none.
std::string_view content_of(std::string_view text)
{
    if (!text.starts_with(kOpen) || !text.ends_with(kClose)) return {};
    text.remove_prefix(kOpen.size()), text.remove_suffix(kClose.size());
    return text;
}

}  // namespace

Result<std::vector<model::ValueNode>> read_template(const XmlElement& element)
{
    Errors errors;
    const auto refuse = [&](const XmlElement& at, std::string why) {
        errors.push_back({{{}, at.where.line, at.where.column}, "<template>", std::move(why)});
    };
    if (!element.attributes.empty()) refuse(element, "takes no attributes");
    if (element.text.find_first_not_of(" \t\r\n") != std::string::npos) refuse(element, "holds text outside of its component");
    if (element.children.size() != 1 || element.children.front().name != "component")
        refuse(element, "holds one <component>, which may be a group of several");
    if (!errors.empty()) return errors;
    Text text;
    text.add(kOpen), text.put(element.children.front()), text.add(kClose);
    std::string whole = text.take();
    if (auto read = read_blueprint(whole, ""); !read) return read.errors();
    return std::vector<model::ValueNode>{{"template", std::move(whole), {{}, element.where.line, element.where.column}}};
}

std::string write_template(const std::string& text, std::size_t indent)
{
    std::string_view content = content_of(text);
    if (content.empty() || !read_blueprint(text, "")) return {};
    content.remove_prefix(std::min(content.size(), content.find_first_not_of('\n')));
    return std::string(indent, ' ') + "<template>" + std::string(content) + "</template>\n";
}

ForeignHandlers standard_handlers()
{
    ForeignHandlers handlers = xgl_handlers();
    handlers.add({"template", "", &read_template});
    return handlers;
}

}  // namespace plab::blueprint
