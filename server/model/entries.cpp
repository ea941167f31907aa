#include "model/entries.h"

#include "model/numbers.h"
#include "model/text.h"

namespace plab::model
{

namespace
{

/// Reads the quoted text at the front of `rest` and takes it off; false if it never ends.
bool take_quoted(std::string_view& rest, std::string& out)
{
    for (std::size_t i = 1; i < rest.size(); ++i)
    {
        if (rest[i] == '\'' && i + 1 < rest.size() && rest[i + 1] == '\'')
            ++i;
        else if (rest[i] == '\'')
        {
            rest.remove_prefix(i + 1);
            return true;
        }
        out += rest[i];
    }
    return false;
}

std::string_view take_word(std::string_view& rest, std::string_view stops)
{
    const std::string_view word = rest.substr(0, rest.find_first_of(stops));
    rest.remove_prefix(word.size());
    return word;
}

}  // namespace

Result<Value> parse_entries(std::string_view text, const Field& field)
{
    const std::string prefix = field.name + ": ";
    Entries out;
    for (std::string_view rest = trimmed(text); !rest.empty(); rest = trimmed(rest))
    {
        Entry entry;
        entry.name = take_word(rest, "= \t\n\r");
        if (entry.name.empty() || !rest.starts_with('=')) return reason(prefix + "entries are written name=value");
        rest.remove_prefix(1);
        if (rest.starts_with('\''))
        {
            std::string value;
            if (!take_quoted(rest, value)) return reason(prefix + "the text of " + quoted(entry.name) + " has no closing quote");
            entry.value = std::move(value);
        }
        else
        {
            const std::string_view word = take_word(rest, " \t\n\r");
            Result<double> number = parse_real(word);
            if (word == "true" || word == "false")
                entry.value = word == "true";
            else if (number)
                entry.value = *number;
            else
                return reason(prefix + number.error().reason);
        }
        out.push_back(std::move(entry));
    }
    return Value(std::move(out));
}

std::string format_entries(const Entries& entries)
{
    std::string out;
    for (const Entry& e : entries)
    {
        out += (out.empty() ? "" : " ") + e.name + "=";
        if (const auto* b = std::get_if<bool>(&e.value)) out += *b ? "true" : "false";
        if (const auto* d = std::get_if<double>(&e.value)) out += format_real(*d);
        const auto* s = std::get_if<std::string>(&e.value);
        if (!s) continue;
        out += '\'';
        for (const char c : *s) out += c == '\'' ? "''" : std::string(1, c);
        out += '\'';
    }
    return out;
}

}  // namespace plab::model
