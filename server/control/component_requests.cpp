#include "control/component_requests.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "control/operations.h"
#include "model/text.h"

namespace plab::control
{
namespace
{

constexpr std::array<std::string_view, 10> kAllowed{"add", "remove", "swap", "set", "push", "pause", "resume", "step", "rate", "dt"};

/// The words "NAME=VALUE" of an argument; what comes before the first one is the argument proper. A value reaches to the next name, so that
/// vectors need no quotes: "impulse=0 0 1 point=1 0 0".
Result<void> split_values(const std::string& text, wire::Operation& out)
{
    out.argument.clear();
    for (const std::string_view word : model::split_words(text))
    {
        const std::size_t equals = word.find('=');
        if (equals == 0) return reason("a value has no name: " + model::quoted(word));
        if (equals != std::string_view::npos)
            out.values.push_back({std::string(word.substr(0, equals)), std::string(word.substr(equals + 1))});
        else
        {
            std::string& to = out.values.empty() ? out.argument : out.values.back().text;
            to += (to.empty() ? "" : " ") + std::string(word);
        }
    }
    return {};
}

}  // namespace

simulation::RequestReader component_request_reader(model::TypeSource& types, const model::CompileLimits& limits)
{
    return [&types, limits](const std::string& verb, const std::string& target, const std::string& argument) -> Result<simulation::Request>
    {
        if (std::find(kAllowed.begin(), kAllowed.end(), verb) == kAllowed.end())
            return reason("a component cannot ask for " + model::quoted(verb));
        wire::Request text;
        wire::Operation& op = text.operations.emplace_back();
        op.verb = verb, op.target = target, op.argument = argument;
        if (verb == "add")
            op.blueprint = argument, op.argument = target.empty() ? "a component's request" : target, op.target.clear();
        else if (verb == "swap" || verb == "set" || verb == "push")
            if (auto split = split_values(argument, op); !split) return split.errors();
        auto wanted = wanted_of(text, types, limits);
        if (!wanted) return wanted.errors();
        return std::move(wanted->request);
    };
}

}  // namespace plab::control
