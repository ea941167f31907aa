#include "idl/recording/source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "idl/recording/file_error.h"
#include "idl/recording/parse.h"

namespace plab::recording
{
Result<FileSource> FileSource::open(const std::string& path)
{
    const int descriptor = uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); });
    if (descriptor < 0) return file_error(path, "cannot open the recording");
    FileSource out(descriptor, path);
    struct stat status
    {
    };
    if (::fstat(descriptor, &status) < 0) return file_error(path, "cannot examine the recording");
    if (!S_ISREG(status.st_mode))
    {
        Error error = reason("is not a file; recordings are read from files");
        error.where.file = path;
        return error;
    }
    return out;
}

FileSource::FileSource(FileSource&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}

FileSource::~FileSource()
{
    if (descriptor_ >= 0) (void)::close(descriptor_);  // nothing was written
}

Result<std::uint64_t> FileSource::size() const
{
    struct stat status
    {
    };
    if (::fstat(descriptor_, &status) < 0) return file_error(path_, "cannot determine the size");
    return static_cast<std::uint64_t>(status.st_size);
}

Result<std::size_t> FileSource::read(std::uint64_t offset, std::span<std::uint8_t> into) const
{
    std::size_t done = 0;
    while (done < into.size())
    {
        const auto rest = into.subspan(done);
        const ssize_t n = uninterrupted([&] { return ::pread(descriptor_, rest.data(), rest.size(), static_cast<off_t>(offset + done)); });
        if (n < 0) return file_error(path_, "cannot read");
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    return done;
}

Result<std::size_t> MemorySource::read(std::uint64_t offset, std::span<std::uint8_t> into) const
{
    if (offset >= bytes_.size()) return std::size_t{0};
    const ByteView there = bytes_.subspan(offset, std::min(into.size(), bytes_.size() - offset));
    std::copy(there.begin(), there.end(), into.begin());
    return there.size();
}

Result<std::size_t> WatchedSource::read(std::uint64_t offset, std::span<std::uint8_t> into) const
{
    const auto all = source_->size();
    const double share = all && *all > 0 ? static_cast<double>(offset) / static_cast<double>(*all) : 0.0;
    if (watch_ && !watch_(share)) return reason("interrupted");
    return source_->read(offset, into);
}

Result<ByteView> Window::view(std::uint64_t offset, std::size_t n)
{
    const bool is_inside = offset >= begin_ && offset - begin_ <= bytes_.size() && bytes_.size() - (offset - begin_) >= n;
    if (!is_inside)
    {
        bytes_.resize(kMost);
        auto done = source_->read(offset, bytes_);
        if (!done)
        {
            bytes_.clear();
            return done.errors();
        }
        bytes_.resize(*done);
        begin_ = offset;
    }
    const ByteView there = ByteView(bytes_).subspan(offset - begin_);
    return there.first(std::min(n, there.size()));
}

Result<ByteView> Window::exactly(std::uint64_t offset, std::size_t n)
{
    auto there = view(offset, n);
    if (there && there->size() < n) return damage(offset, "the file ends here");
    return there;
}

}  // namespace plab::recording
