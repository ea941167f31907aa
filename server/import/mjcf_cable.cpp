#include "import/mjcf_cable.h"

namespace plab::import
{

void Sites::read(const XmlElement& own, const std::string& childclass, const std::string& body, MjcfSettings& settings, Document& document)
{
    const std::string name = document.text(own, "name");
    if (name.empty()) return document.lost(own, "is not carried over");
    list_unused_attributes(own, document);
    if (!sites_.try_emplace(name, Site{{body, settings.pose(settings.resolved(own, childclass)).p}, &own}).second)
        document.error(own, "there are two sites of this name");
}

const Cable::End* Sites::find(const std::string& name)
{
    const auto at = sites_.find(name);
    if (at == sites_.end()) return nullptr;
    at->second.used = true;
    return &at->second.end;
}

void Sites::list_unused(Document& document) const
{
    for (const auto& [name, site] : sites_)
        if (!site.used) document.lost(*site.element, "is not carried over: no tendon uses it");
}

namespace
{

/// limited and range, of lengths.
void read_range(const XmlElement& e, const MjcfSettings& settings, Cable& out, Document& document)
{
    double range[2];
    const bool given = document.numbers(e, "range", range, 2) == 2;
    const std::string limited = document.text(e, "limited");
    if (limited == "false" || (limited != "true" && !(given && settings.auto_limits()))) return;
    if (!given) return document.error(e, "is limited, but has no range");
    if (!(range[0] < range[1])) return document.error(e, "range must be two ascending numbers");
    if (range[0] > 0) out.lower = range[0];
    out.upper = range[1];
}

void read_spring(const XmlElement& e, Cable& out, Document& document)
{
    out.stiffness = document.number(e, "stiffness", 0), out.damping = document.number(e, "damping", 0);
    if (out.stiffness < 0 || out.damping < 0) document.error(e, "stiffness and damping must not be negative");
    double rest[2];
    const std::size_t given = document.numbers(e, "springlength", rest, 1);
    if (given > 0 && rest[0] >= 0) out.rest = rest[0];
    if (given == 2 && rest[1] != rest[0] && out.stiffness > 0)
        document.lost(e, "springlength: the spring has one length without force, the first number");
}

/// Its straight parts between sites. False if it is listed.
bool read_path(const XmlElement& own, Sites& sites, Cable& out, Document& document)
{
    const Cable::End* before = nullptr;
    double divisor = 1;
    for (const XmlElement& child : own.children)
    {
        if (child.name == "geom") return document.lost(own, "is not carried over: it winds around a shape"), false;
        if (child.name == "pulley")
            document.list_attributes(child, {"divisor"}), divisor = document.positive(child, "divisor"), before = nullptr;
        else if (child.name == "site")
        {
            document.list_attributes(child, {"site"});
            const Cable::End* const end = sites.find(document.text(child, "site"));
            if (!end) return document.error(child, "there is no site '" + document.text(child, "site") + "'"), false;
            if (before) out.parts.push_back({*before, *end, divisor});
            before = end;
        }
        else
            document.lost(child, "is not carried over");
    }
    if (out.parts.empty()) document.error(own, "needs two sites");
    return !out.parts.empty();
}

}  // namespace

std::optional<Cable> read_cable(const XmlElement& own, Sites& sites, MjcfSettings& settings, Document& document)
{
    document.list_attributes(
        own, {"name", "class", "limited", "range", "springlength", "stiffness", "damping", "group", "width", "rgba", "material"});
    const XmlElement e = settings.resolved(own, "");
    Cable out;
    out.name = document.text(e, "name"), out.where = own.where;
    if (out.name.empty()) out.name = "tendon";
    if (!read_path(own, sites, out, document)) return {};
    read_range(e, settings, out, document);
    read_spring(e, out, document);
    return out;
}

}  // namespace plab::import
