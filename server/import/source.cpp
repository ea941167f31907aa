#include "import/source.h"

#include <filesystem>
#include <fstream>

namespace plab::import
{
namespace
{

/// Keeps the whole document as a tree.
class TreeSink : public blueprint::XmlSink
{
public:
    bool begin(const XmlElement&) override { return false; }
    void child(XmlElement) override {}
    void end(XmlElement root) override { root_ = std::move(root); }
    XmlElement take() { return std::move(root_); }

private:
    XmlElement root_;
};

blueprint::XmlLimits limits()
{
    blueprint::XmlLimits out;
    out.bytes = kMostSourceBytes, out.depth = 200, out.elements = 200'000, out.text = std::size_t{4} << 20;
    return out;
}

void set_file(XmlElement& e, std::uint32_t file)
{
    e.where.file = e.text_where.file = file;
    for (XmlElement& child : e.children) set_file(child, file);
}

}  // namespace

Result<std::string> read_bytes(const std::string& path, std::size_t most)
{
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) return Error{{path, 0, 0}, {}, "is a folder, not a file"};
    std::ifstream file(path, std::ios::binary);
    if (!file) return Error{{path, 0, 0}, {}, "cannot be opened"};
    // One byte more than allowed shows that there are too many.
    std::string bytes;
    char buffer[1 << 16];
    while (file && bytes.size() <= most)
    {
        file.read(buffer, sizeof buffer);
        bytes.append(buffer, static_cast<std::size_t>(file.gcount()));
    }
    return bytes;
}

XmlElement read_tree(std::string_view text, std::uint32_t file, Document& document)
{
    TreeSink tree;
    Errors errors;
    blueprint::parse_xml(text, limits(), tree, errors);
    for (const Error& error : errors) document.error({error.where.line, error.where.column, file}, error.element, error.reason);
    XmlElement root = tree.take();
    if (file != 0) set_file(root, file);
    return root;
}

bool IncludedFiles::read(const std::string& path, const XmlElement& from, XmlElement& root)
{
    if (document_.files() > kMostIncludedFiles) return document_.error(from, "is one file too many: 1000 are allowed"), false;
    const auto text = read_bytes(path, kMostSourceBytes);
    if (!text) return document_.error(from, "the file " + path + " " + text.error().reason), false;
    bytes_ += text->size();
    if (bytes_ > kMostIncludedBytes) return document_.error(from, "the files of this scene have more than 64 MiB together"), false;
    const std::size_t errors = document_.errors().size();
    root = read_tree(*text, document_.add_file(path), document_);
    return document_.errors().size() == errors;
}

}  // namespace plab::import
