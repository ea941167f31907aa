// Arguments that are more than a number or a name: the budget of a trial, the name of a request, a rate.
#include <charconv>

#include "control/operations.h"

namespace plab::control
{

Result<simulation::TrialChoice> parse_trial(const std::string& text)
{
    using Budget = simulation::TrialChoice::Budget;
    constexpr std::string_view kRefuse = "or refuse";
    simulation::TrialChoice out;
    out.budget = Budget::Automatic;
    std::string_view time = text;
    if (time.ends_with(kRefuse))
    {
        out.must = true;
        time.remove_suffix(kRefuse.size());
    }
    while (time.ends_with(' ')) time.remove_suffix(1);
    if (time.empty() && out.must) return out;
    if (time == "none" && !out.must)
    {
        out.budget = Budget::None;
        return out;
    }
    if (time == "unlimited" && !out.must)
    {
        out.budget = Budget::Unlimited;
        return out;
    }
    constexpr double kMost = 1e9;  // ms
    double ms = 0;
    std::string_view number = time;
    if (number.ends_with("ms")) number.remove_suffix(2);
    while (number.ends_with(' ')) number.remove_suffix(1);
    const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), ms);
    if (error != std::errc() || stop != number.data() + number.size() || !(ms > 0) || !(ms <= kMost))
        return reason("'" + text.substr(0, 64) +
                      "' is not a budget of a trial: give none, unlimited, or a time in ms; 'or refuse' after it refuses untested swaps");
    out.budget = Budget::Given, out.ns = 1e6 * ms;
    return out;
}

Result<Wanted::Cancelled> parse_request_name(const std::string& text)
{
    Wanted::Cancelled out;
    const std::size_t digits = 2 * out.client.size();
    bool fine = text.size() > digits + 1 && text[digits] == ':';
    for (std::size_t i = 0; fine && i < out.client.size(); ++i)
    {
        const char* const from = text.data() + 2 * i;
        const auto [stop, error] = std::from_chars(from, from + 2, out.client[i], 16);
        fine = error == std::errc() && stop == from + 2;
    }
    if (fine)
    {
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data() + digits + 1, end, out.number);
        fine = error == std::errc() && stop == end && out.number > 0;
    }
    if (!fine)
        return reason("'" + text.substr(0, 64) +
                      "' is not the name of a request: give the client's 32 hexadecimal digits, ':', and the number");
    return out;
}

Result<double> parse_rate(const std::string& text)
{
    if (text == "real") return 1.0;
    if (text == "max") return 0.0;
    double factor = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), factor);
    if (error != std::errc() || end != text.data() + text.size() || !(factor >= 1e-6) || !(factor <= 1e9))
        return reason("a rate must be real, max or a factor of real time from 1e-6 to 1e9, not '" + text + "'");
    return factor;
}

}  // namespace plab::control
