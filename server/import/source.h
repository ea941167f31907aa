/// Files as trees of elements, within limits on everything.
#pragma once

#include <string>
#include <string_view>

#include "import/document.h"

namespace plab::import
{

/// A file that is read as a whole has at most this many bytes.
inline constexpr std::size_t kMostSourceBytes = std::size_t{16} << 20;
/// The files of one scene have at most this many together.
inline constexpr std::size_t kMostIncludedBytes = std::size_t{64} << 20;
inline constexpr std::size_t kMostIncludedFiles = 1000;

/// At most `most` bytes, and one more if there are more. Errors: a folder, or a file that cannot be opened.
Result<std::string> read_bytes(const std::string& path, std::size_t most);

/// The root element of a text. Errors go into `document`; then the tree may be incomplete. `file`: number of the file in the document.
XmlElement read_tree(std::string_view text, std::uint32_t file, Document& document);

/// Files that others include: each read once, all within the limits.
class IncludedFiles
{
public:
    explicit IncludedFiles(Document& document) : document_(document) {}
    /// The root of the file at `path`, for the element `from` that names it. Errors go into the document: then false.
    bool read(const std::string& path, const XmlElement& from, XmlElement& root);

private:
    Document& document_;
    std::size_t bytes_ = 0;
};

}  // namespace plab::import
