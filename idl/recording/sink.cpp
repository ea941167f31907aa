#include "idl/recording/sink.h"

#include <fcntl.h>
#include <unistd.h>

#include <utility>

#include "idl/recording/file_error.h"

namespace plab::recording
{
Result<FileSink> FileSink::open(const std::string& path, Overwrite overwrite)
{
    const int mode = overwrite == Overwrite::Yes ? O_TRUNC : O_EXCL;
    const int descriptor = uninterrupted([&] { return ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | mode, 0666); });
    if (descriptor < 0) return file_error(path, "cannot create the file");
    return FileSink(descriptor, path);
}

FileSink::FileSink(FileSink&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}

FileSink::~FileSink()
{
    if (descriptor_ >= 0) (void)::close(descriptor_);  // callers that need the result have called close() before
}

Error FileSink::failed(const char* what) const { return file_error(path_, what); }

Result<void> FileSink::append(ByteView bytes)
{
    while (!bytes.empty())
    {
        const ssize_t n = uninterrupted([&] { return ::write(descriptor_, bytes.data(), bytes.size()); });
        if (n == 0) errno = EIO;  // nothing written and no error given: retrying would never end
        if (n <= 0) return failed("cannot write");
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return {};
}

Result<void> FileSink::truncate(std::uint64_t size)
{
    const auto end = static_cast<off_t>(size);
    if (uninterrupted([&] { return ::ftruncate(descriptor_, end); }) < 0) return failed("cannot truncate a part that failed");
    if (::lseek(descriptor_, end, SEEK_SET) < 0) return failed("cannot seek back to where a write failed");
    return {};
}

Result<void> FileSink::sync()
{
    if (uninterrupted([&] { return ::fdatasync(descriptor_); }) < 0) return failed("cannot flush the data to the disk");
    return {};
}

Result<void> FileSink::close()
{
    // Linux releases the descriptor whatever close returns; a retry could close another thread's file.
    const int descriptor = std::exchange(descriptor_, -1);
    if (descriptor >= 0 && ::close(descriptor) < 0 && errno != EINTR) return failed("cannot close");
    return {};
}

}  // namespace plab::recording
