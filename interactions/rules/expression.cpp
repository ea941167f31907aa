#include "expression.h"

#include <charconv>
#include <cmath>
#include <optional>

namespace plab::rules
{
namespace
{

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool begins_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool continues_name(char c) { return begins_name(c) || is_digit(c) || c == '.'; }

/// sum = product { (+|-) product },  product = factor { (*|/) factor },  factor = number | name | -factor | ( sum )
class Reading
{
public:
    Reading(std::string_view text, const Names& names) : text_(text), names_(names) {}

    Result<double> run()
    {
        const double value = sum();
        if (!error_ && (skip_blanks(), at_ < text_.size())) fail("'" + std::string(text_.substr(at_)) + "' is not expected");
        if (error_) return reason("'" + std::string(text_) + "': " + *error_);
        return value;
    }

private:
    void fail(std::string why)
    {
        if (!error_) error_ = std::move(why);
    }
    void skip_blanks()
    {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) ++at_;
    }
    bool take(char c)
    {
        skip_blanks();
        if (at_ >= text_.size() || text_[at_] != c) return false;
        return ++at_, true;
    }
    double sum()
    {
        double value = product();
        while (!error_)
            if (take('+'))
                value += product();
            else if (take('-'))
                value -= product();
            else
                break;
        return value;
    }
    double product()
    {
        double value = factor();
        while (!error_)
            if (take('*'))
                value *= factor();
            else if (take('/'))
                value /= factor();
            else
                break;
        return value;
    }
    double factor()
    {
        constexpr int kDeepest = 32;
        if (++depth_ > kDeepest) fail("is nested too deeply");
        double value = 0;
        if (error_)
            value = 0;
        else if (take('-'))
            value = -factor();
        else if (take('('))
        {
            value = sum();
            if (!take(')')) fail("a ')' is missing");
        }
        else
            value = operand();
        --depth_;
        return value;
    }
    double operand()
    {
        skip_blanks();
        const std::size_t from = at_;
        double value = 0;
        if (at_ < text_.size() && begins_name(text_[at_]))
        {
            while (at_ < text_.size() && continues_name(text_[at_])) ++at_;
            const auto known = names_(text_.substr(from, at_ - from));
            if (!known) return fail(known.error().reason), 0.0;
            return *known;
        }
        const auto [end, wrong] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (wrong != std::errc() || from == text_.size()) return fail("a number or a name is missing"), 0.0;
        at_ = static_cast<std::size_t>(end - text_.data());
        return value;
    }

    std::string_view text_;
    const Names& names_;
    std::size_t at_ = 0;
    int depth_ = 0;
    std::optional<std::string> error_;
};

}  // namespace

Result<double> evaluate(std::string_view text, const Names& names)
{
    auto value = Reading(text, names).run();
    if (value && !std::isfinite(*value)) return reason("'" + std::string(text) + "' is not finite");
    return value;
}

Result<void> check_expression(std::string_view text)
{
    const auto done = Reading(text, [](std::string_view) -> Result<double> { return 1.0; }).run();
    if (!done) return done.errors();
    return {};
}

bool is_name(std::string_view text)
{
    if (text.empty() || !begins_name(text.front())) return false;
    for (const char c : text)
        if (!continues_name(c)) return false;
    return true;
}

}  // namespace plab::rules
