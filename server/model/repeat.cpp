#include "model/repeat.h"

#include <unordered_set>

#include "model/names.h"
#include "model/numbers.h"
#include "model/text.h"
#include "model/values.h"
#include "plab/random.h"

namespace plab::model::detail
{

namespace
{

/// More cells than any limit allows, but few enough that products of three counts fit 64 bits.
constexpr std::int64_t kMostPerAxis = 1'000'000;

Result<void> read_count(const TextNode& text, Repeat& out)
{
    const std::vector<std::string_view> words = split_words(text.text);
    if (words.empty() || words.size() > 3) return reason("count needs 1 to 3 whole numbers, has " + std::to_string(words.size()));
    out.dimensions = static_cast<int>(words.size());
    for (std::size_t k = 0; k < words.size(); ++k)
    {
        Result<std::int64_t> n = parse_integer(words[k]);
        if (!n) return reason("count: " + n.error().reason);
        if (*n < 1) return reason("count must be 1 or more, not " + std::to_string(*n));
        if (*n > kMostPerAxis) return reason("count must be at most 1000000, not " + std::to_string(*n));
        out.count[k] = *n;
    }
    return {};
}

Result<Vec3> read_lengths(const TextNode& text)
{
    Field field;
    field.name = text.name;
    field.unit = unit::metre;
    field.type = FieldType::RealList;
    const bool jitter = text.name == "jitter";
    if (jitter) field.rules.push_back({Rule::Kind::AtLeast, 0, {}});
    Result<Value> value = parse_value(text.text, field);
    if (!value) return value.errors();
    const Reals& n = std::get<Reals>(*value);
    if (jitter && n.size() == 1) return Vec3{n[0], n[0], n[0]};
    if (n.size() != 3) return reason(text.name + " needs 3 numbers" + (jitter ? " or 1" : "") + ", has " + std::to_string(n.size()));
    return Vec3{n[0], n[1], n[2]};
}

Result<void> read_attribute(const TextNode& text, Repeat& out)
{
    const std::vector<std::string> names{"id", "count", "step", "jitter", "origin"};
    if (text.name == "id") return out.id = text.text, Result<void>();
    if (text.name == "count") return read_count(text, out);
    if (text.name != "step" && text.name != "jitter" && text.name != "origin")
        return reason("unknown attribute " + quoted(text.name) + did_you_mean(text.name, names) + " (attributes are " + quoted_list(names) +
                      ")");
    Result<Vec3> v = read_lengths(text);
    if (!v) return v.errors();
    (text.name == "step" ? out.step : text.name == "jitter" ? out.jitter : out.origin) = *v;
    return {};
}

}  // namespace

std::array<std::int64_t, 3> Repeat::cell(std::size_t n) const
{
    const auto at = static_cast<std::int64_t>(n);
    return {at / (count[1] * count[2]), at / count[2] % count[1], at % count[2]};
}

std::string Repeat::suffix(std::size_t n) const
{
    const std::array<std::int64_t, 3> at = cell(n);
    std::string out;
    for (int k = 0; k < dimensions; ++k) out += "." + std::to_string(at[static_cast<std::size_t>(k)]);
    return out;
}

Vec3 Repeat::offset(std::size_t n, std::uint64_t seed, const std::string& first_id) const
{
    const std::array<std::int64_t, 3> at = cell(n);
    const double i = static_cast<double>(at[0]), j = static_cast<double>(at[1]), k = static_cast<double>(at[2]);
    Vec3 out = origin;
    out += dimensions == 1 ? i * step : Vec3{i * step.x, j * step.y, k * step.z};
    std::uint64_t stream = seed_for(seed, first_id.data(), first_id.size());
    for (int axis = 0; axis < 3; ++axis) out[axis] += jitter[axis] * (2 * next_uniform(stream) - 1);
    return out;
}

Result<Repeat> read_repeat(const RepeatNode& node)
{
    Repeat out;
    Errors errors;
    std::unordered_set<std::string> seen;
    for (const TextNode& text : node.attributes)
    {
        if (!seen.insert(text.name).second) errors.push_back({text.where, {}, text.name + " is given twice"});
        if (Result<void> r = read_attribute(text, out); !r) errors.push_back({text.where, {}, r.error().reason});
    }
    if (!seen.contains("count")) errors.push_back({node.where, {}, "count is missing: give 1 to 3 whole numbers"});
    if (node.components.empty()) errors.push_back({node.where, {}, "holds no component to repeat"});
    if (out.dimensions == 2 && out.step.z != 0) errors.push_back({node.where, {}, "step has a z component, but count has no third number"});
    if (!errors.empty()) return errors;
    return out;
}

}  // namespace plab::model::detail
