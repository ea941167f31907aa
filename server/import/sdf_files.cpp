#include "import/sdf_files.h"

#include <algorithm>
#include <filesystem>

#include "import/sdf_text.h"

namespace plab::import
{
namespace
{

namespace fs = std::filesystem;

/// Puts `child` in the place of the first one of its name.
void put_child(XmlElement& e, const XmlElement& child)
{
    const auto found = std::ranges::find(e.children, child.name, &XmlElement::name);
    if (found == e.children.end())
        e.children.push_back(child);
    else
        *found = child;
}

void put_attribute(XmlElement& e, const std::string& name, const std::string& value)
{
    const auto found = std::ranges::find(e.attributes, name, &blueprint::XmlAttribute::name);
    if (found == e.attributes.end())
        e.attributes.push_back({name, value});
    else
        found->value = value;
}

}  // namespace

std::string SdfFiles::find(const std::string& uri, const XmlElement& by) const
{
    constexpr std::string_view kModel = "model://", kFile = "file://";
    std::error_code ignored;
    const auto if_there = [&](const fs::path& path) { return fs::exists(path, ignored) ? path.string() : std::string(); };
    const fs::path home = fs::absolute(document_.file_of(by.where), ignored).parent_path();
    if (uri.starts_with(kFile)) return if_there(uri.substr(kFile.size()));
    if (!uri.starts_with(kModel)) return uri.find("://") == std::string::npos ? if_there(home / uri) : std::string();
    const std::string inside = uri.substr(kModel.size());
    for (const std::string& folder : folders_)
        if (std::string found = if_there(fs::path(folder) / inside); !found.empty()) return found;
    for (fs::path at = home; !at.empty(); at = at.parent_path())
    {
        if (std::string found = if_there(at / inside); !found.empty()) return found;
        if (at == at.root_path()) break;
    }
    return {};
}

std::string SdfFiles::file_in(const std::string& folder, const XmlElement& by)
{
    const fs::path config = fs::path(folder) / "model.config";
    std::error_code ignored;
    std::string name = "model.sdf";
    XmlElement root;
    if (fs::is_regular_file(config, ignored))
    {
        if (!files_.read(config.string(), by, root)) return {};
        for (const XmlElement& child : root.children)
            if (child.name == "sdf") name = std::string(trimmed(child.text));
    }
    return (fs::path(folder) / name).string();
}

bool SdfFiles::include(const XmlElement& include, XmlElement& model, double& version)
{
    document_.list_attributes(include, {"placement_frame", "merge"});
    document_.list_children(include, {"uri", "name", "pose", "static", "placement_frame"});
    const std::string uri = sdf_text(include, "uri");
    if (document_.text(include, "merge") == "true") return document_.error(include, "merge=\"true\" is not supported"), false;
    std::string path = find(uri, include);
    if (path.empty()) return document_.error(include, "there is no '" + uri + "': name the folder that holds it with --import-path"), false;
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) path = file_in(path, include);
    if (path.empty()) return false;
    auto known = read_.find(path);
    if (known == read_.end())
    {
        XmlElement root;
        if (!files_.read(path, include, root)) return false;
        if (root.name != "sdf") return document_.error(root, "is not the root of SDF, which is <sdf>"), false;
        known = read_.emplace(path, std::move(root)).first;
    }
    version = document_.number(known->second, "version", version);
    const XmlElement* const found = find_child(known->second, "model");
    if (!found) return document_.lost(include, "is not carried over: " + path + " has no <model>"), false;
    model = *found;
    for (const char* const name : {"pose", "static"})
        if (const XmlElement* const given = find_child(include, name)) put_child(model, *given);
    if (const std::string name = sdf_text(include, "name"); !name.empty()) put_attribute(model, "name", name);
    std::string placement = document_.text(include, "placement_frame");
    if (placement.empty()) placement = sdf_text(include, "placement_frame");
    if (!placement.empty()) put_attribute(model, "placement_frame", placement);
    return true;
}

}  // namespace plab::import
