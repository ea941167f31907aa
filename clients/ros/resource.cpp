#include "ros/resource.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <vector>

#include "plab/number_text.h"
#include "plab/xml_text.h"

namespace plab::ros
{
namespace
{

constexpr std::size_t kMostBytes = std::size_t{4} << 20;  // as much as a request may have

Result<std::string> read_file(const std::string& path)
{
    std::error_code error;
    // A pipe or a device might never end.
    if (!std::filesystem::is_regular_file(path, error)) return reason("'" + path + "' is no file that can be read");
    std::ifstream file(path, std::ios::binary);
    std::string out(kMostBytes + 1, '\0');
    file.read(out.data(), static_cast<std::streamsize>(out.size()));
    if (!file.eof() || file.bad()) return reason("'" + path + "' cannot be read, or has more than 4 MiB");
    out.resize(static_cast<std::size_t>(file.gcount()));
    return out;
}

/// "" if the URI names no file of this host.
std::string path_of(const std::string& uri)
{
    constexpr std::string_view kScheme = "file://";
    std::string path = uri.starts_with(kScheme) ? uri.substr(kScheme.size()) : uri;
    return path.starts_with('/') ? path : std::string();
}

std::string format_of(const std::string& text)
{
    const std::string root = first_element(text);
    if (root == "plab" || root == "component") return "plab";
    if (root == "robot") return "urdf";
    return root == "mujoco" ? "mjcf" : "";
}

constexpr std::string_view kBlanks = " \t\r\n";

/// Where the first element begins, after declarations and comments; npos: there is none.
std::size_t find_first(std::string_view xml)
{
    for (std::size_t at = xml.find('<'); at != std::string_view::npos; at = xml.find('<', at))
    {
        const std::string_view rest = xml.substr(at);
        const std::string_view close = rest.starts_with("<!--") ? "-->" : rest.starts_with("<?") ? "?>" : "";
        if (close.empty()) return at;
        at = xml.find(close, at);
        if (at == std::string_view::npos) break;
    }
    return std::string_view::npos;
}

/// The first tag, up to its '>' or "/>": its name and its attributes with the text between their quotes, as they are written.
struct FirstTag
{
    std::string name;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::size_t begin = 0, end = 0;  ///< in the text; `end`: of what is left after the attributes
};

std::optional<FirstTag> read_first_tag(std::string_view xml)
{
    FirstTag out;
    out.begin = find_first(xml);
    if (out.begin == std::string_view::npos) return {};
    std::size_t at = xml.find_first_of(std::string(kBlanks) + "/>", out.begin);
    if (at == std::string_view::npos) return {};
    out.name = xml.substr(out.begin + 1, at - out.begin - 1);
    while (true)
    {
        at = xml.find_first_not_of(kBlanks, at);
        if (at == std::string_view::npos) return {};
        if (xml[at] == '>' || xml[at] == '/') break;
        const std::size_t equal = xml.find('=', at);
        const std::size_t open = equal == std::string_view::npos ? equal : xml.find_first_of("\"'", equal);
        const std::size_t close = open == std::string_view::npos ? open : xml.find(xml[open], open + 1);
        if (close == std::string_view::npos) return {};
        const std::string_view name = xml.substr(at, equal - at);
        out.attributes.emplace_back(name.substr(0, name.find_last_not_of(kBlanks) + 1), xml.substr(open + 1, close - open - 1));
        at = close + 1;
    }
    out.end = at;
    return out;
}

std::string joined(std::initializer_list<double> numbers)
{
    std::string out;
    for (const double number : numbers) out += (out.empty() ? "" : " ") + number_text(number);
    return out;
}

}  // namespace

std::string first_element(const std::string& xml)
{
    const auto tag = read_first_tag(xml);
    return tag ? tag->name : std::string();
}

std::string first_attribute(const std::string& xml, const std::string& name)
{
    if (const auto tag = read_first_tag(xml))
        for (const auto& [key, value] : tag->attributes)
            if (key == name) return value;
    return {};
}

Result<ReadResource> read_resource(const simulation_interfaces_msg_dds__Resource_& resource)
{
    ReadResource out;
    const std::string uri = text_of(resource.uri);
    if (uri.empty())
        out.text = text_of(resource.resource_string);
    else
    {
        out.file = path_of(uri);
        if (out.file.empty()) return reason("'" + uri + "' names no file of this host: file:///PATH");
        auto text = read_file(out.file);
        if (!text) return text.errors();
        out.text = text.take();
    }
    if (out.text.empty()) return reason("");
    out.format = format_of(out.text);
    return out;
}

Result<std::string> with_name_and_place(const std::string& blueprint, const std::string& id, const Pose& place)
{
    const auto tag = read_first_tag(blueprint);
    if (!tag || tag->name != "component") return reason("begins with no <component>");
    const bool is_group = first_attribute(blueprint, "type").empty();
    if (is_group && !(place == Pose{})) return reason("a group has no place of its own: give its bodies theirs, and no initial_pose");
    std::string out = "<component id=\"" + xml_text(id) + "\"";
    for (const auto& [name, value] : tag->attributes)
        if (name != "id" && (is_group || (name != "position" && name != "orientation")))
            out += " " + name + (value.find('"') == std::string::npos ? "=\"" + value + "\"" : "='" + value + "'");
    const Quat& q = place.q;
    if (!is_group)
        out += " position=\"" + joined({place.p.x, place.p.y, place.p.z}) + "\" orientation=\"" + joined({q.w, q.x, q.y, q.z}) + "\"";
    return out + blueprint.substr(tag->end);
}

}  // namespace plab::ros
