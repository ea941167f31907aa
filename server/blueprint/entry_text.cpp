#include "blueprint/entry_text.h"

#include <cmath>

#include "model/numbers.h"
#include "model/text.h"

namespace plab::blueprint
{
namespace
{

using EntryValue = std::variant<bool, double, std::string>;

}  // namespace

Result<EntryValue> parse_entry(std::string_view text)
{
    const std::string_view t = model::trimmed(text);
    if (t.empty()) return reason("needs a value; \"\" is the empty text");
    if (t == "true") return EntryValue(true);
    if (t == "false") return EntryValue(false);
    if (t[0] == '"' || t[0] == '\'')
    {
        if (t.size() < 2 || t.back() != t[0]) return reason("the quote of the text " + model::quoted(t) + " is not closed");
        return EntryValue(std::string(t.substr(1, t.size() - 2)));
    }
    if (!model::looks_like_number(t)) return EntryValue(std::string(t));
    const std::string hint = "; write it in double quotes if it is a text";
    const Result<double> number = model::parse_real(t);
    if (!number) return reason(number.error().reason + hint);
    if (!std::isfinite(*number)) return reason(model::quoted(t) + " is not finite" + hint);
    return EntryValue(*number);
}

std::string format_entry(const EntryValue& value)
{
    if (const bool* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
    if (const double* d = std::get_if<double>(&value)) return model::format_real(*d);
    return '"' + std::get<std::string>(value) + '"';
}

}  // namespace plab::blueprint
