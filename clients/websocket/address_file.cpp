#include "websocket/address_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <utility>

namespace plab::websocket
{

Result<AddressFile> AddressFile::write(const std::string& file, const std::string& url)
{
    if (file.empty()) return AddressFile({});
    (void)unlink(file.c_str());
    constexpr int kMode = 0600;
    const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
    const std::string line = url + "\n";
    const bool is_written = fd >= 0 && ::write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    if (fd >= 0) (void)close(fd);
    if (!is_written) return reason("cannot write '" + file + "'");
    return AddressFile(file);
}

AddressFile::AddressFile(AddressFile&& other) noexcept : file_(std::exchange(other.file_, {})) {}

AddressFile::~AddressFile()
{
    if (!file_.empty()) (void)unlink(file_.c_str());
}

}  // namespace plab::websocket
