#include "plugins/manifest_text.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace plab::plugins
{
namespace
{

constexpr std::size_t kMostTypes = 10'000;
constexpr std::size_t kMostPerType = 1'000;  ///< roles, and also fields
constexpr std::size_t kLongestName = 200;
constexpr std::size_t kLongestLine = 1'000'000;
constexpr std::string_view kHexDigits = "0123456789abcdef";

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

std::string escaped(std::string_view text)
{
    std::string out;
    for (const char c : text)
        if (c == '\\')
            out += "\\\\";
        else if (is_control(c))
            out += std::string("\\x") + kHexDigits[static_cast<unsigned char>(c) / 16] + kHexDigits[static_cast<unsigned char>(c) % 16];
        else
            out += c;
    return out;
}

Result<std::string> unescaped(std::string_view cell)
{
    std::string out;
    for (std::size_t i = 0; i < cell.size(); ++i)
    {
        if (is_control(cell[i])) return reason("holds a control character; it must be written as \\x and two digits");
        if (cell[i] != '\\')
        {
            out += cell[i];
            continue;
        }
        const std::string_view rest = cell.substr(i + 1);
        if (rest.starts_with('\\'))
        {
            out += '\\', ++i;
            continue;
        }
        const std::size_t high = rest.size() >= 3 && rest[0] == 'x' ? kHexDigits.find(rest[1]) : kHexDigits.npos;
        const std::size_t low = high != kHexDigits.npos ? kHexDigits.find(rest[2]) : kHexDigits.npos;
        if (low == kHexDigits.npos) return reason("holds a '\\' that is neither '\\\\' nor '\\x' and two digits");
        out += static_cast<char>(high * 16 + low), i += 3;
    }
    return out;
}

std::string line_of(std::initializer_list<std::string_view> cells)
{
    std::string out;
    for (const std::string_view cell : cells) out += (out.empty() ? "" : "\t") + escaped(cell);
    return out + "\n";
}

/// The cells after the keyword of the line.
Result<std::vector<std::string>> cells_of(std::string_view line)
{
    std::vector<std::string> out;
    for (std::size_t begin = 0; begin <= line.size();)
    {
        const std::size_t end = std::min(line.find('\t', begin), line.size());
        auto cell = unescaped(line.substr(begin, end - begin));
        if (!cell) return cell.errors();
        out.push_back(cell.take());
        begin = end + 1;
    }
    return out;
}

template <class Number>
Result<Number> number_of(const std::string& text, const char* what)
{
    Number n{};
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (failed != std::errc() || end != text.data() + text.size()) return reason(std::string(what) + " is not a whole number in range");
    return n;
}

bool is_type_name(std::string_view name)
{
    const auto fits = [](char c)
    { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '/'; };
    return !name.empty() && name.size() <= kLongestName && name.front() != '/' && name.back() != '/' &&
           std::all_of(name.begin(), name.end(), fits);
}

}  // namespace

Result<void> ManifestReader::add(std::string_view line)
{
    struct Kind
    {
        std::string_view word;
        std::size_t cells;  // including the keyword
        Result<void> (ManifestReader::*add)(Cells&);
    };
    constexpr Kind kinds[] = {{"plugin", 2, &ManifestReader::add_plugin},
                              {"type", 10, &ManifestReader::add_type},
                              {"role", 6, &ManifestReader::add_role},
                              {"field", 9, &ManifestReader::add_field}};
    if (line.empty()) return {};
    if (line.size() > kLongestLine) return reason("is longer than " + std::to_string(kLongestLine) + " bytes");
    auto cells = cells_of(line);
    if (!cells) return cells.errors();
    for (const Kind& kind : kinds)
    {
        if (cells->front() != kind.word) continue;
        if (cells->size() != kind.cells)
            return reason("a '" + std::string(kind.word) + "' line has " + std::to_string(kind.cells) + " cells, not " +
                          std::to_string(cells->size()));
        return (this->*kind.add)(*cells);
    }
    return reason("does not begin with a keyword of a manifest; plugin, type, role and field are allowed");
}

Result<void> ManifestReader::add_plugin(Cells& cells)
{
    if (!plugin_.empty()) return reason("names a second plugin");
    if (cells[1].empty() || cells[1].size() > kLongestName) return reason("names no plugin");
    plugin_ = std::move(cells[1]);
    return {};
}

Result<void> ManifestReader::add_type(Cells& cells)
{
    if (!is_type_name(cells[1])) return reason("is not a type name; letters, digits, '_' and '/' are allowed");
    if (types_.size() >= kMostTypes) return reason("more than " + std::to_string(kMostTypes) + " types");
    auto order = number_of<int>(cells[3], "the order of convergence");
    if (!order) return order.errors();
    model::TypeSummary& type = types_.emplace_back();
    type.name = std::move(cells[1]), type.family = std::move(cells[2]), type.order = *order, type.doc = std::move(cells[4]);
    type.accuracy = std::move(cells[5]), type.strengths = std::move(cells[6]);
    type.cost = std::move(cells[7]), type.limits = std::move(cells[8]), type.source = std::move(cells[9]);
    return {};
}

Result<void> ManifestReader::add_role(Cells& cells)
{
    if (types_.empty()) return reason("a role before the first type");
    std::vector<model::RoleSummary>& roles = types_.back().roles;
    if (roles.size() >= kMostPerType) return reason("more than " + std::to_string(kMostPerType) + " roles of one type");
    auto least = number_of<std::uint32_t>(cells[3], "the least number of participants");
    if (!least) return least.errors();
    auto most = number_of<std::uint32_t>(cells[4], "the largest number of participants");
    if (!most) return most.errors();
    roles.push_back({std::move(cells[1]), std::move(cells[2]), std::move(cells[5]), *least, *most});
    return {};
}

Result<void> ManifestReader::add_field(Cells& cells)
{
    if (types_.empty()) return reason("a field before the first type");
    std::vector<model::FieldSummary>& fields = types_.back().fields;
    if (fields.size() >= kMostPerType) return reason("more than " + std::to_string(kMostPerType) + " fields of one type");
    if (cells[6] != "required" && cells[6] != "optional") return reason("a field must be 'required' or 'optional'");
    fields.push_back({std::move(cells[1]), std::move(cells[2]), std::move(cells[3]), std::move(cells[4]), std::move(cells[5]),
                      std::move(cells[7]), std::move(cells[8]), cells[6] == "required"});
    return {};
}

Result<std::vector<model::TypeSummary>> ManifestReader::finish()
{
    if (plugin_.empty()) return reason("names no plugin");
    std::sort(types_.begin(), types_.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    const auto twice = std::adjacent_find(types_.begin(), types_.end(), [](const auto& a, const auto& b) { return a.name == b.name; });
    if (twice != types_.end()) return reason("names " + twice->name + " twice");
    for (model::TypeSummary& type : types_) type.plugin = plugin_;
    return std::move(types_);
}

std::string manifest_lines(const std::string& plugin, const std::vector<model::TypeSummary>& types)
{
    std::string out = line_of({"plugin", plugin});
    for (const model::TypeSummary& t : types)
    {
        out += line_of({"type", t.name, t.family, std::to_string(t.order), t.doc, t.accuracy, t.strengths, t.cost, t.limits, t.source});
        for (const model::RoleSummary& r : t.roles)
            out += line_of({"role", r.name, r.accepts, std::to_string(r.least), std::to_string(r.most), r.doc});
        for (const model::FieldSummary& f : t.fields)
            out +=
                line_of({"field", f.name, f.kind, f.value_type, f.unit, f.fallback, f.required ? "required" : "optional", f.rule, f.doc});
    }
    return out;
}

}  // namespace plab::plugins
