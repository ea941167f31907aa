/// <spatial> of MJCF's <tendon>: cables between sites.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "import/mjcf_settings.h"
#include "import/robot.h"

namespace plab::import
{

/// Points of bodies that have names.
class Sites
{
public:
    /// <site> of a body.
    void read(const XmlElement& own, const std::string& childclass, const std::string& body, MjcfSettings& settings, Document& document);
    /// Null if there is none of this name. It counts as used.
    const Cable::End* find(const std::string& name);
    /// Lists those that nothing uses.
    void list_unused(Document& document) const;

private:
    struct Site
    {
        Cable::End end;
        const XmlElement* element = nullptr;
        bool used = false;
    };
    std::map<std::string, Site> sites_;
};

/// One <spatial>. None, and listed, if it winds around shapes.
std::optional<Cable> read_cable(const XmlElement& own, Sites& sites, MjcfSettings& settings, Document& document);

}  // namespace plab::import
