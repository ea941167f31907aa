#include "model/alike.h"

#include <unordered_map>

#include "model/text.h"

namespace plab::model
{
namespace
{

constexpr std::size_t kShown = 3;

/// Replaces each number by '#': "b.12" and "b.7" are cells of one repeat.
void add_without_numbers(std::string& out, const std::string& text)
{
    for (const char c : text)
        if (!is_digit(c))
            out += c;
        else if (out.empty() || out.back() != '#')
            out += '#';
}

std::string kind_of(const Error& e)
{
    std::string out = place_text(e.where) + "\n";
    add_without_numbers(out, e.element);
    add_without_numbers(out += "\n", e.reason);
    return out;
}

}  // namespace

Errors first_of_alike(Errors errors)
{
    if (errors.size() <= kShown) return errors;
    struct Kind
    {
        std::size_t count = 0, last_shown = 0;
    };
    std::unordered_map<std::string, Kind> kinds;
    std::vector<const Kind*> kind_of_shown;
    Errors shown;
    for (Error& e : errors)
    {
        Kind& kind = kinds[kind_of(e)];
        if (++kind.count > kShown) continue;
        kind.last_shown = shown.size();
        shown.push_back(std::move(e));
        kind_of_shown.push_back(&kind);
    }
    Errors out;
    for (std::size_t k = 0; k < shown.size(); ++k)
    {
        out.push_back(std::move(shown[k]));
        const Kind& kind = *kind_of_shown[k];
        if (kind.last_shown == k && kind.count > kShown)
            out.push_back({out.back().where, {}, "and " + std::to_string(kind.count - kShown) + " more like it"});
    }
    return out;
}

}  // namespace plab::model
