#include "template_text.h"

#include <charconv>

#include "expression.h"
#include "plab/xml_text.h"

namespace plab::rules
{
namespace
{

std::string unescaped(std::string_view text)
{
    constexpr std::pair<std::string_view, char> kWords[] = {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&#39;", '\''}};
    std::string out;
    while (!text.empty())
    {
        std::size_t taken = 1;
        char c = text.front();
        for (const auto& [word, character] : kWords)
            if (text.starts_with(word)) taken = word.size(), c = character;
        out += c;
        text.remove_prefix(taken);
    }
    return out;
}

std::string text_of(const Value& value)
{
    if (const auto* text = std::get_if<std::string>(&value)) return xml_text(*text);
    if (const auto* number = std::get_if<double>(&value)) return in_digits(*number);
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
    if (const auto* truth = std::get_if<bool>(&value)) return *truth ? "true" : "false";
    if (const auto* v = std::get_if<Vec3>(&value)) return in_digits(v->x) + " " + in_digits(v->y) + " " + in_digits(v->z);
    if (const auto* q = std::get_if<Quat>(&value))
        return in_digits(q->w) + " " + in_digits(q->x) + " " + in_digits(q->y) + " " + in_digits(q->z);
    return {};
}

/// Calls visit(content, before) for each ${content}, with the text since the last one; the rest of the text is returned.
template <class Visit>
Result<std::string_view> for_each_place(std::string_view text, Visit visit)
{
    for (std::size_t open; (open = text.find("${")) != std::string_view::npos;)
    {
        const std::size_t close = text.find('}', open);
        if (close == std::string_view::npos) return reason("template: '${' is not closed by '}'");
        if (auto done = visit(text.substr(open + 2, close - open - 2), text.substr(0, open)); !done) return done.errors();
        text.remove_prefix(close + 1);
    }
    return text;
}

Error in_template(std::string_view content, const std::string& why)
{
    return reason("template: ${" + std::string(content.substr(0, 100)) + "}: " + why);
}

}  // namespace

std::string in_digits(double value)
{
    char digits[40];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    return {digits, end};
}

Result<void> check_template(std::string_view text)
{
    auto rest = for_each_place(text,
                               [](std::string_view content, std::string_view) -> Result<void>
                               {
                                   if (auto fine = check_expression(content); !fine) return in_template(content, fine.error().reason);
                                   return {};
                               });
    if (!rest) return rest.errors();
    if (first_id(text).empty()) return reason("template: holds no component with an id");
    return {};
}

Result<double> number_of(std::string_view expression, const Known& known)
{
    return evaluate(expression,
                    [&](std::string_view name) -> Result<double>
                    {
                        const auto value = known(name);
                        if (!value) return reason("there is no '" + std::string(name) + "'");
                        if (const auto* number = std::get_if<double>(&*value)) return *number;
                        if (const auto* whole = std::get_if<std::int64_t>(&*value)) return static_cast<double>(*whole);
                        return reason("'" + std::string(name) + "' is no number");
                    });
}

Result<std::string> fill_template(std::string_view text, const Known& known)
{
    std::string out;
    const auto fill = [&](std::string_view content, std::string_view before) -> Result<void>
    {
        out += before;
        if (is_name(content))
        {
            const auto value = known(content);
            if (!value) return in_template(content, "neither object, connector nor shape has it");
            out += text_of(*value);
            return {};
        }
        const auto number = number_of(content, known);
        if (!number) return in_template(content, number.error().reason);
        out += in_digits(*number);
        return {};
    };
    auto rest = for_each_place(text, fill);
    if (!rest) return rest.errors();
    return out + std::string(*rest);
}

std::string first_id(std::string_view blueprint)
{
    const std::size_t component = blueprint.find("<component");
    if (component == std::string_view::npos) return {};
    std::string_view tag = blueprint.substr(component, blueprint.find('>', component) - component);
    for (std::size_t at = tag.find("id"); at != std::string_view::npos; at = tag.find("id", at + 1))
    {
        const char before = tag[at - 1];
        if (before != ' ' && before != '\n' && before != '\t') continue;
        const std::size_t quote = tag.find_first_of("\"'", at);
        if (quote == std::string_view::npos || tag.substr(at + 2, quote - at - 2).find_first_not_of(" =\n\t") != std::string_view::npos)
            continue;
        return unescaped(tag.substr(quote + 1, tag.find(tag[quote], quote + 1) - quote - 1));
    }
    return {};
}

}  // namespace plab::rules
