#include "blueprint/reader.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "blueprint/template.h"
#include "blueprint/tree.h"

namespace plab::blueprint
{
namespace
{

struct FileCloser
{
    void operator()(std::FILE* f) const { std::fclose(f); }
};

/// The file's bytes; stops one byte after `most`, so that reading an endless file ends.
Result<std::string> read_bytes(const std::string& path, std::size_t most)
{
    const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.c_str(), "rb"));
    if (!file) return Error{{path, 0, 0}, {}, std::string("cannot be opened: ") + std::strerror(errno)};
    std::string bytes;
    char buffer[1 << 16];
    while (bytes.size() <= most)
    {
        const std::size_t n = std::fread(buffer, 1, sizeof buffer, file.get());
        if (n == 0) break;
        bytes.append(buffer, n);
    }
    if (std::ferror(file.get())) return Error{{path, 0, 0}, {}, std::string("cannot be read: ") + std::strerror(errno)};
    return bytes;
}

/// One value, "template". The grammar is checked here; ids and values that contain ${...} are not.
Result<std::vector<model::ValueNode>> read_template(const XmlElement& element)
{
    auto text = template_text(element);
    if (!text) return text.errors();
    if (auto read = read_blueprint(*text, ""); !read) return read.errors();
    return std::vector<model::ValueNode>{{"template", text.take(), {{}, element.where.line, element.where.column}}};
}

}  // namespace

ForeignHandlers standard_handlers()
{
    ForeignHandlers handlers = xgl_handlers();
    handlers.add({"template", "", &read_template});
    return handlers;
}

Result<model::Blueprint> read_blueprint(std::string_view text, const std::string& file_name, const ForeignHandlers& handlers,
                                        const XmlLimits& limits)
{
    Complaints complaints(file_name);
    TreeReader tree(file_name, handlers, complaints);
    Errors form;
    parse_xml(text, limits, tree, form);
    for (Error& error : form) complaints.add(std::move(error));
    if (complaints.any()) return complaints.take();
    return tree.take();
}

Result<model::Blueprint> read_blueprint_file(const std::string& path, const ForeignHandlers& handlers, const XmlLimits& limits)
{
    Result<std::string> text = read_bytes(path, limits.bytes);
    if (!text) return text.errors();
    return read_blueprint(*text, path, handlers, limits);
}

}  // namespace plab::blueprint
