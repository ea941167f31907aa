#include "import/mjcf_include.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "import/source.h"

namespace plab::import
{
namespace
{

namespace fs = std::filesystem;

class Includer
{
public:
    explicit Includer(Document& document) : document_(document), files_(document)
    {
        std::error_code ignored;
        home_ = fs::absolute(document.file(), ignored).parent_path();
        seen_.insert(fs::weakly_canonical(document.file(), ignored));
    }

    void expand(XmlElement& e)
    {
        std::vector<XmlElement> children;
        for (XmlElement& child : e.children)
            if (child.name == "include")
                insert(child, children);
            else
                expand(child), children.push_back(std::move(child));
        e.children = std::move(children);
    }

private:
    void insert(const XmlElement& include, std::vector<XmlElement>& to)
    {
        document_.list_all_but(include, {"file"});
        const std::string name = document_.text(include, "file");
        if (name.empty()) return document_.error(include, "needs a file");
        const fs::path path = home_ / name;
        std::error_code ignored;
        if (!seen_.insert(fs::weakly_canonical(path, ignored)).second)
            return document_.error(include, "the file '" + name + "' is included a second time");
        XmlElement root;
        if (!files_.read(path.string(), include, root)) return;
        if (root.name != "mujoco" && root.name != "mujocoinclude")
            return document_.error(root, "is not the root of MJCF, which is <mujoco> or <mujocoinclude>");
        expand(root);
        for (XmlElement& child : root.children) to.push_back(std::move(child));
    }

    Document& document_;
    IncludedFiles files_;
    fs::path home_;
    std::set<fs::path> seen_;
};

}  // namespace

void put_together(XmlElement& root, Document& document)
{
    Includer(document).expand(root);
    std::vector<XmlElement> sections;
    for (XmlElement& child : root.children)
    {
        const auto same = std::ranges::find(sections, child.name, &XmlElement::name);
        // Attributes of a later <compiler> or <option> count; each <default> is a tree of its own.
        const bool joins = child.name == "worldbody" || child.name == "asset" || child.name == "actuator" || child.name == "contact" ||
                           child.name == "equality";
        if (same != sections.end() && joins)
            std::ranges::move(child.children, std::back_inserter(same->children));
        else
            sections.push_back(std::move(child));
    }
    root.children = std::move(sections);
}

}  // namespace plab::import
