#include "web/files.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

namespace plab::web
{
namespace
{

constexpr std::pair<const char*, const char*> kFiles[] = {
    {"index.html", "text/html; charset=utf-8"}, {"page.js", "text/javascript; charset=utf-8"}, {"page.css", "text/css; charset=utf-8"}};

std::string text_of(const std::string& file)
{
    std::ifstream in(file, std::ios::binary);
    std::stringstream out;
    out << in.rdbuf();
    return out.str();
}

}  // namespace

Result<PageFiles> PageFiles::load(const std::string& folder)
{
    PageFiles out;
    for (const auto& [name, type] : kFiles)
    {
        std::string bytes = text_of(folder + "/" + name);
        if (!bytes.empty())
        {
            out.files_[name] = std::make_shared<const websocket::File>(websocket::File{type, std::move(bytes)});
            continue;
        }
        std::string why = text_of(folder + "/not_built.txt");
        while (why.ends_with('\n')) why.pop_back();
        return reason("the page is not there (" + folder + "/" + name + ")" + (why.empty() ? "" : ": " + why));
    }
    return out;
}

std::shared_ptr<const websocket::File> PageFiles::find(const std::string& name) const
{
    const auto at = files_.find(name.empty() ? "index.html" : name);
    return at == files_.end() ? nullptr : at->second;
}

std::string page_folder()
{
    namespace fs = std::filesystem;
    std::error_code failed;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed);
    return (program.parent_path() / "../share/plab/web").lexically_normal().string();
}

}  // namespace plab::web
