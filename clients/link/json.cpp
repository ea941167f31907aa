#include "link/json.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "idl/samples.h"
#include "link/text.h"

namespace plab::link
{
namespace
{

/// One entry of events or of collisions, with its place in front.
template <class Entry, class Sample>
Json placed(const Sample& sample, std::uint32_t entry)
{
    const auto& one = sample.entries._buffer[entry];
    Json out{{"run", sample.run}, {"sequence_number", sample.sequence_number + entry}, {"step", sample.step}, {"time", one.time}};
    out.update(json_of(wire::value_of<Entry>(one)));
    return out;
}

/// Builds the value of a sample while it is decoded. What is open is the last element of its parent, so its address stays the same
/// until it is closed.
class SampleJson final : public SampleVisitor
{
public:
    explicit SampleJson(Numbers numbers) : numbers_(numbers) {}
    void open_struct(const DynamicType&) override { open_.push_back(&add(Json::object())); }
    void member(std::string_view name) override { name_ = name; }
    void close_struct() override { open_.pop_back(); }
    void open_list(const DynamicType&, std::size_t) override { open_.push_back(&add(Json::array())); }
    void close_list() override { open_.pop_back(); }
    void scalar(const Scalar& value) override
    {
        if (numbers_ == Numbers::Quoted)
            add(std::visit([](const auto& v) { return quoted(v); }, value));
        else
            add(std::visit([](const auto& v) { return plain(v); }, value));
    }
    Json take() { return std::move(root_); }

private:
    Json& add(Json value)
    {
        if (open_.empty()) return root_ = std::move(value);
        if (open_.back()->is_array()) return open_.back()->emplace_back(std::move(value));
        // Names of members differ: looking for the key, as `[]` does, would make long structs quadratic.
        auto& members = open_.back()->get_ref<Json::object_t&>();
        return members.Container::emplace_back(std::string(name_), std::move(value)).second;
    }

    template <class T>
    static Json plain(const T& v)
    {
        return v;
    }
    /// 0.1f is 0.1 and not 0.10000000149011612: the double that the shortest text of the float stands for.
    static Json plain(float v)
    {
        if (!std::isfinite(v)) return nullptr;
        const std::string text = number_text(v);
        double out = 0;
        (void)std::from_chars(text.data(), text.data() + text.size(), out);
        return out;
    }
    static Json plain(const EnumValue& v) { return v.literal.empty() ? Json(v.number) : Json(v.literal); }

    static Json quoted(bool v) { return v; }
    static Json quoted(std::int64_t v) { return std::to_string(v); }
    static Json quoted(std::uint64_t v) { return std::to_string(v); }
    static Json quoted(float v) { return number_text(v); }
    static Json quoted(double v) { return number_text(v); }
    static Json quoted(std::string_view v) { return v; }
    static Json quoted(const EnumValue& v) { return std::to_string(v.number); }

    Numbers numbers_;
    Json root_;
    std::vector<Json*> open_;
    std::string_view name_;
};

}  // namespace

Json json_of(const plab_v2_Events& sample, std::uint32_t entry) { return placed<wire::EventInfo>(sample, entry); }
Json json_of(const plab_v2_Collisions& sample, std::uint32_t entry) { return placed<wire::CollisionInfo>(sample, entry); }

Result<Json> json_of(const DynamicType& type, std::span<const std::byte> bytes, Numbers numbers)
{
    SampleJson out(numbers);
    if (auto decoded = decode(type, bytes, out); !decoded) return decoded.errors();
    return out.take();
}

}  // namespace plab::link
