// Samples as text: tree_of of dynamic_sample.h.
#include "link/dynamic_sample.h"
#include "link/text.h"

namespace plab::link
{
namespace
{

std::string shown(bool v) { return v ? "true" : "false"; }
std::string shown(std::int64_t v) { return std::to_string(v); }
std::string shown(std::uint64_t v) { return std::to_string(v); }
std::string shown(float v) { return number_text(v); }
std::string shown(double v) { return number_text(v); }
std::string shown(std::string_view v) { return "\"" + terminal_text(v) + "\""; }
std::string shown(const EnumValue& v) { return v.literal.empty() ? std::to_string(v.number) + " (no literal)" : terminal_text(v.literal); }

bool has_only_scalars(const DynamicType& type)
{
    for (const DynamicMember& member : type.members)
        if (!is_scalar(*member.type)) return false;
    return true;
}

/// Indented lines. What has only scalars in it stands on one line: "{x: 0, y: 1}", "[1, 2]".
class TreeVisitor final : public SampleVisitor
{
public:
    explicit TreeVisitor(std::size_t most) : most_(most) {}

    void open_struct(const DynamicType& type) override
    {
        const bool is_inline = !levels_.empty() && has_only_scalars(type);
        begin_value(is_inline ? "{" : "");
        levels_.push_back({is_inline, false, 0, 0});
    }
    void member(std::string_view name) override
    {
        Level& level = levels_.back();
        if (hidden_ > 0) return;
        const bool is_first = level.count++ == 0;
        if (level.is_inline)
            text_ += is_first ? "" : ", ";
        else
            new_line(is_first);
        text_ += terminal_text(name);
        text_ += ": ";
    }
    void close_struct() override { end_level("}"); }
    void open_list(const DynamicType& element, std::size_t count) override
    {
        const bool is_inline = is_scalar(element) || count == 0;
        begin_value(is_inline ? "[" : "");
        levels_.push_back({is_inline, true, 0, count});
    }
    void close_list() override
    {
        const Level& level = levels_.back();
        if (hidden_ == 0 && level.size > most_)
        {
            if (level.is_inline)
                text_ += ", ";
            else
                new_line(false);
            text_ += "... and " + std::to_string(level.size - most_) + " more";
        }
        end_level("]");
    }
    void scalar(const Scalar& value) override
    {
        begin_value("");
        if (hidden_ == 0) text_ += std::visit([](const auto& v) { return shown(v); }, value);
        end_value();
    }
    std::string take() { return std::exchange(text_, {}) + "\n"; }

private:
    struct Level
    {
        bool is_inline = false, is_list = false;
        std::size_t count = 0;  ///< what was begun in it
        std::size_t size = 0;   ///< elements that it has
    };

    /// Elements of lists stand behind their comma or their dash, or are left out.
    void begin_value(std::string_view bracket)
    {
        if (hidden_ > 0 || (!levels_.empty() && levels_.back().is_list && levels_.back().count >= most_))
        {
            ++hidden_;
            return;
        }
        if (!levels_.empty() && levels_.back().is_list)
        {
            Level& level = levels_.back();
            const bool is_first = level.count++ == 0;
            if (level.is_inline)
                text_ += is_first ? "" : ", ";
            else
                new_line(is_first), text_ += "- ";
        }
        text_ += bracket;
    }
    void end_value()
    {
        if (hidden_ > 0) --hidden_;
    }
    void end_level(std::string_view bracket)
    {
        if (hidden_ == 0 && levels_.back().is_inline) text_ += bracket;
        levels_.pop_back();
        end_value();
    }
    /// The first member of an element stands behind its dash.
    void new_line(bool is_first)
    {
        if (text_.empty() || (is_first && text_.ends_with("- "))) return;
        if (text_.ends_with(": ")) text_.pop_back();
        text_ += '\n';
        text_.append(2 * (levels_.size() - 1), ' ');
    }

    std::size_t most_;
    std::size_t hidden_ = 0;  ///< levels of values that are left out
    std::vector<Level> levels_;
    std::string text_;
};

}  // namespace

Result<std::string> tree_of(const DynamicType& type, std::span<const std::byte> bytes, std::size_t most)
{
    TreeVisitor visitor(most);
    if (auto decoded = decode(type, bytes, visitor); !decoded) return decoded.errors();
    return visitor.take();
}

}  // namespace plab::link
