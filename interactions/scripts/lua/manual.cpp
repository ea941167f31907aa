// The description of what a script can use, for the reference of component types; generated from the tables that register it.
#include "lua/native.h"

namespace plab::scripts
{
namespace
{

std::string row(const std::string& name, const std::string& unit, const std::string& meaning)
{
    return "| `" + name + "` | " + unit + " | " + meaning + " |\n";
}

/// "math.sin(angle)", "vector:dot(other)": methods follow the name of what they belong to.
std::string rows_of(const NativeGroup& group)
{
    const std::string prefix = group.prefix;
    const bool is_library = prefix.empty() || prefix.ends_with('.');
    std::string out;
    for (const NativeValue& v : group.values) out += row(prefix + (is_library ? "" : ".") + v.name, v.unit, v.meaning);
    for (const NativeFunction& f : group.functions)
        if (!std::string_view(f.name).starts_with("__")) out += row(prefix + (is_library ? "" : ":") + f.name + f.arguments, "", f.meaning);
    return out;
}

}  // namespace

std::string manual()
{
    std::string out =
        "\n#### What a script can use\n\n"
        "The code defines `drive(step)`, called once per step, `force(t, state)`, called at every solver stage (t in s), or both. "
        "`force` is pure: it adds forces, torques and rates and changes nothing else. `driver`, `driven` and `between[i]` are the "
        "participants (a body, a shaft or quantities each; nil without one), `state.name` and `parameters.name` the declared entries; "
        "`state` can be assigned in `drive`.\n\n| name | unit | meaning |\n|---|---|---|\n";
    for (const NativeGroup& g : participant_groups()) out += rows_of(g);
    out += rows_of(step_group());
    for (const NativeGroup& g : vector_groups()) out += rows_of(g);
    for (const NativeGroup& g : {effects_group(), base_group(), math_group(), string_group(), table_group()}) out += rows_of(g);
    const auto number = [](auto n) { return std::to_string(n); };
    return out + "\nLimits: `instruction_budget` instructions for a call, " + number(kLoadFactor) +
           " times as many while loading; `memory_limit` bytes; " + number(Meter::kBytesPerInstruction) +
           " bytes asked for per instruction of the budget; texts of " + number(kLongestText) +
           " bytes. There is no `next`, no metatable, no coroutine, no `load`, nothing of `io os debug package`.\n";
}

}  // namespace plab::scripts
