/// The files of the page: all of them in memory, read once. A request can name nothing else.
#pragma once

#include <map>
#include <string>

#include "plab/result.h"
#include "websocket/server.h"

namespace plab::web
{

class PageFiles
{
public:
    /// index.html, page.js and page.css of a folder. An error says why the page was not built, if it was not.
    static Result<PageFiles> load(const std::string& folder);
    /// "" is index.html; null: there is no such file.
    std::shared_ptr<const websocket::File> find(const std::string& name) const;

private:
    std::map<std::string, std::shared_ptr<const websocket::File>> files_;
};

/// Where the page is: share/plab/web beside the program's folder, or that of the build.
std::string page_folder();

}  // namespace plab::web
