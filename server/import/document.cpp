#include "import/document.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "model/numbers.h"
#include "plab/rotation.h"
#include "plab/symmetric.h"

namespace plab::import
{
namespace
{

constexpr std::string_view kBlanks = " \t\r\n";
/// Larger numbers are mistakes, and their powers would not fit into a double.
constexpr double kLargest = 1e30;

std::string_view take_word(std::string_view& rest)
{
    const std::size_t begin = rest.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return rest = {};
    rest.remove_prefix(begin);
    const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
    rest.remove_prefix(word.size());
    return word;
}

std::optional<double> read_number(std::string_view word)
{
    if (word.find('/') != std::string_view::npos) return {};
    const auto value = model::parse_real(word);
    if (!value || !(std::fabs(*value) <= kLargest)) return {};
    return *value;
}

std::string shown(const std::string& text) { return "'" + (text.size() > 60 ? text.substr(0, 60) + "..." : text) + "'"; }

}  // namespace

std::string Document::title_of(const XmlElement& e)
{
    const std::string* const name = e.find_attribute("name");
    return blueprint::in_tags(e.name) + (name ? " '" + *name + "'" : "");
}

void Document::error(TextPosition where, std::string element, std::string why)
{
    if (errors_.size() < kMostErrors) errors_.push_back({{file_of(where), where.line, where.column}, std::move(element), std::move(why)});
}

void Document::lost(TextPosition where, std::string element, std::string why)
{
    losses_.push_back({where, {{file_of(where), where.line, where.column}, std::move(element), std::move(why)}});
}

Errors Document::losses() const
{
    auto sorted = losses_;
    std::ranges::stable_sort(sorted, {}, [](const auto& loss) { return std::tuple(loss.first.file, loss.first.line, loss.first.column); });
    Errors out;
    for (auto& loss : sorted) out.push_back(std::move(loss.second));
    return out;
}

std::uint32_t Document::add_file(std::string file)
{
    files_.push_back(std::move(file));
    return static_cast<std::uint32_t>(files_.size() - 1);
}

std::size_t Document::read_numbers(const XmlElement& e, std::string_view what, const std::string& text, std::span<double> out,
                                   std::size_t least)
{
    std::string_view rest = text;
    std::size_t n = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++n)
    {
        const auto value = n < out.size() ? read_number(word) : std::nullopt;
        if (!value)
        {
            error(e, std::string(what) + " must be " + (least == out.size() ? "" : "up to ") + std::to_string(out.size()) +
                         (out.size() == 1 ? " number" : " numbers") + ", not " + shown(text));
            return 0;
        }
        out[n] = *value;
    }
    if (n >= least) return n;
    error(e, std::string(what) + " needs " + std::to_string(least) + (least == 1 ? " number" : " numbers") + ", not " + shown(text));
    return 0;
}

std::size_t Document::numbers(const XmlElement& e, std::string_view attribute, std::span<double> out, std::size_t least)
{
    const std::string* const text = e.find_attribute(attribute);
    return text ? read_numbers(e, attribute, *text, out, least) : 0;
}

std::size_t Document::numbers_inside(const XmlElement& e, std::span<double> out, std::size_t least)
{
    return read_numbers(e, "its text", std::string(trimmed(e.text)), out, least);
}

double Document::number(const XmlElement& e, std::string_view attribute, double otherwise)
{
    double value = 0;
    return numbers(e, attribute, std::span(&value, 1), 1) == 1 ? value : otherwise;
}

Vec3 Document::vector(const XmlElement& e, std::string_view attribute, const Vec3& otherwise)
{
    double v[3];
    return numbers(e, attribute, v, 3) == 3 ? Vec3{v[0], v[1], v[2]} : otherwise;
}

double Document::positive(const XmlElement& e, std::string_view attribute)
{
    if (!e.find_attribute(attribute)) return error(e, "needs " + std::string(attribute)), 0;
    const double value = number(e, attribute, 1);
    if (value > 0) return value;
    error(e, std::string(attribute) + " must be positive, not " + model::format_real(value));
    return 0;
}

Vec3 Document::direction(const XmlElement& e, std::string_view attribute, const Vec3& otherwise)
{
    const Vec3 given = vector(e, attribute, otherwise);
    if (length(given) > 1e-30) return normalized(given);
    error(e, std::string(attribute) + " must be a direction, not the zero vector");
    return otherwise;
}

std::string Document::text(const XmlElement& e, std::string_view attribute) const
{
    const std::string* const found = e.find_attribute(attribute);
    return found ? *found : std::string();
}

void Document::list_attributes(const XmlElement& e, std::initializer_list<std::string_view> known)
{
    for (const auto& a : e.attributes)
        if (std::ranges::find(known, a.name) == known.end())
            lost(e, "the attribute " + a.name + "=" + shown(a.value) + " is not carried over");
}

void Document::list_children(const XmlElement& e, std::initializer_list<std::string_view> known)
{
    for (const XmlElement& child : e.children)
        if (std::ranges::find(known, child.name) == known.end()) lost(child, "is not carried over");
}

void Document::list_repeated(const XmlElement& e, std::initializer_list<std::string_view> several)
{
    std::set<std::string_view> seen;
    for (const XmlElement& child : e.children)
        if (std::ranges::find(several, child.name) == several.end() && !seen.insert(child.name).second)
            lost(child, "is not carried over: only the first one counts");
}

bool Document::check_mass(TextPosition where, const std::string& element, double mass, const Mat3& inertia)
{
    const auto refuse = [&](const std::string& why) { return error(where, element, why), false; };
    if (!(mass > 0)) return refuse("mass must be positive, not " + model::format_real(mass));
    const Vec3 m = symmetric_axes(inertia).values;
    const double largest = std::max({m.x, m.y, m.z}), sum = m.x + m.y + m.z;
    const std::string text =
        ": its principal moments are " + model::format_real(m.x) + " " + model::format_real(m.y) + " " + model::format_real(m.z);
    if (!(std::min({m.x, m.y, m.z}) > 0)) return refuse("inertia must be positive" + text);
    if (largest > (sum - largest) * (1 + 1e-9)) return refuse("inertia violates the triangle inequality, so no body can have it" + text);
    return true;
}

std::string_view trimmed(std::string_view text)
{
    const std::size_t begin = text.find_first_not_of(kBlanks);
    return begin == std::string_view::npos ? std::string_view() : text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

const XmlElement* find_child(const XmlElement& e, std::string_view name)
{
    const auto found = std::ranges::find(e.children, name, &XmlElement::name);
    return found == e.children.end() ? nullptr : &*found;
}

Quat rotation_of_columns(const Vec3& x, const Vec3& y, const Vec3& z)
{
    // The largest of the four components first, by its square: J. Bar-Itzhack, J. Guidance 23 (2000) 1085, has the others by division.
    const double squares[] = {1 + x.x + y.y + z.z, 1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z, 1 - x.x - y.y + z.z};
    const auto largest = std::ranges::max_element(squares) - squares;
    const double a = 2 * std::sqrt(squares[largest]);
    const double wx = (y.z - z.y) / a, wy = (z.x - x.z) / a, wz = (x.y - y.x) / a;
    const double xy = (y.x + x.y) / a, xz = (z.x + x.z) / a, yz = (z.y + y.z) / a;
    const Quat by_largest[] = {{a / 4, wx, wy, wz}, {wx, a / 4, xy, xz}, {wy, xy, a / 4, yz}, {wz, xz, yz, a / 4}};
    return normalized(by_largest[largest]);
}

Quat rotation_about(const Vec3& axis, double angle) { return exp_rotation(axis * angle); }

Quat rotation_from_z(const Vec3& to)
{
    if (to.z > 1 - 1e-14) return {};
    if (to.z < -1 + 1e-14) return {0, 1, 0, 0};
    return normalized(Quat{1 + to.z, -to.y, to.x, 0});
}

}  // namespace plab::import
