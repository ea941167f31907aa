#include "foxglove/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace plab::foxglove
{
namespace
{

/// Numbers between spaces; nothing: the text is something else, or has numbers that JSON has not.
std::optional<std::vector<double>> numbers_in(const std::string& text)
{
    std::vector<double> out;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at != end)
    {
        double value = 0;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc() || !std::isfinite(value) || (next != end && *next != ' ')) return {};
        out.push_back(value);
        at = std::find_if(next, end, [](char c) { return c != ' '; });
    }
    return out;
}

const std::vector<link::Parameter>* parameters_of(const link::CatalogueContents& now, const std::string& component)
{
    if (const auto at = now.interactions.find(component); at != now.interactions.end()) return &at->second.parameters;
    if (const auto at = now.objects.find(component); at != now.objects.end()) return &at->second.parameters;
    return nullptr;
}

template <class Thing>
void add_names(const std::map<std::string, Thing>& things, std::vector<std::string>& out)
{
    for (const auto& [id, thing] : things)
        for (const link::Parameter& p : thing.parameters)
        {
            if (out.size() > kMostListed) return;
            if (p.kind == "param" || p.kind == "level") out.push_back(id + "." + p.name);
        }
}

}  // namespace

const link::Parameter* find_parameter(const link::CatalogueContents& now, const std::string& name)
{
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) return nullptr;
    const auto* const parameters = parameters_of(now, name.substr(0, dot));
    if (parameters == nullptr) return nullptr;
    const auto is_it = [field = name.substr(dot + 1)](const link::Parameter& p) { return p.name == field; };
    const auto at = std::find_if(parameters->begin(), parameters->end(), is_it);
    return at == parameters->end() ? nullptr : &*at;
}

std::vector<std::string> parameter_names(const link::CatalogueContents& now)
{
    std::vector<std::string> out;
    add_names(now.interactions, out);  // before the objects: there are fewer of them, and they are what is tuned
    add_names(now.objects, out);
    return out;
}

Json parameter_json(const std::string& name, const link::Parameter* parameter)
{
    Json out{{"name", name}};
    if (parameter == nullptr) return out;
    const std::string& text = parameter->text;
    const auto numbers = text.empty() ? std::nullopt : numbers_in(text);
    if (text == "true" || text == "false")
        out["value"] = text == "true";
    else if (numbers && numbers->size() == 1)
        out["value"] = numbers->front(), out["type"] = "float64";
    else if (numbers)
        out["value"] = *numbers, out["type"] = "float64_array";
    else
        out["value"] = text;
    return out;
}

Json parameters_json(const link::CatalogueContents& now, const std::vector<std::string>& names)
{
    Json out = Json::array();
    for (const std::string& name : names)
        if (const link::Parameter* const parameter = find_parameter(now, name)) out.push_back(parameter_json(name, parameter));
    return out;
}

Result<std::vector<link::Operation>> set_operations(const std::vector<wire::NamedText>& values)
{
    std::vector<link::Operation> out;
    for (const auto& [name, value] : values)
    {
        const std::size_t dot = name.rfind('.');
        if (dot == std::string::npos || dot == 0 || dot + 1 == name.size())
            return reason("'" + name + "' is no parameter of a component: write COMPONENT.PARAMETER");
        const std::string component = name.substr(0, dot);
        const auto is_it = [&](const link::Operation& o) { return o.target == component; };
        auto operation = std::find_if(out.begin(), out.end(), is_it);
        if (operation == out.end()) operation = out.insert(out.end(), {"set", component});
        operation->values.push_back({name.substr(dot + 1), value});
    }
    if (out.empty()) return reason("there is nothing to set");
    return out;
}

void ParameterWatch::change(const WatchParameters& said)
{
    if (said.names.empty())
    {
        all_ = said.watches;
        if (!said.watches) names_.clear();
    }
    for (const std::string& name : said.names)
    {
        if (!said.watches)
            names_.erase(name);
        else if (names_.size() < kMost)
            names_.insert(name);
        known_.erase(name);
    }
    if (is_empty()) known_.clear();
}

Json ParameterWatch::changes(const link::CatalogueContents& now)
{
    std::vector<std::string> wanted(names_.begin(), names_.end());
    if (all_)
    {
        wanted = parameter_names(now);
        if (wanted.size() > kMostListed) wanted.pop_back();
    }
    Json out = Json::array();
    for (const std::string& name : wanted)
    {
        const link::Parameter* const parameter = find_parameter(now, name);
        const auto [known, is_new] = known_.try_emplace(name);
        const std::string text = parameter == nullptr ? std::string() : parameter->text;
        if (!is_new && known->second == text) continue;
        known->second = text;
        if (parameter != nullptr) out.push_back(parameter_json(name, parameter));
    }
    return out;
}

}  // namespace plab::foxglove
