/// Where SDF finds models and meshes: model://NAME/REST, file:// and paths relative to the file that names them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "import/source.h"

namespace plab::import
{

class SdfFiles
{
public:
    /// `folders`: in which model:// is looked for, in this order; then the file's own folder and those above it.
    SdfFiles(std::vector<std::string> folders, Document& document) : folders_(std::move(folders)), document_(document), files_(document) {}

    /// The path of a file or folder; "" if there is none. `by`: the element that names it.
    std::string find(const std::string& uri, const XmlElement& by) const;
    /// The model that <include> names, with its name, pose, placement frame and <static> in place of the model's own. `version` becomes
    /// that of the model's file. False with an error.
    bool include(const XmlElement& include, XmlElement& model, double& version);

private:
    /// model.config names the file; the last one, which is for the newest version.
    std::string file_in(const std::string& folder, const XmlElement& by);

    std::vector<std::string> folders_;
    Document& document_;
    IncludedFiles files_;
    std::map<std::string, XmlElement> read_;  ///< by path
};

}  // namespace plab::import
