#include "daemon/wake.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

namespace plab::daemon
{

Result<Wake> Wake::make()
{
    const int descriptor = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (descriptor < 0) return reason(std::string("cannot make an eventfd: ") + std::strerror(errno));
    return Wake(descriptor);
}

Wake::Wake(Wake&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

Wake::~Wake()
{
    if (descriptor_ >= 0) close(descriptor_);
}

void Wake::wake() const
{
    const std::uint64_t one = 1;
    // If the counter is full, an earlier wake has not been read yet: nothing is lost.
    [[maybe_unused]] const auto written = ::write(descriptor_, &one, sizeof one);
}

bool Wake::wait_until(Clock::time_point due) const
{
    const auto left = std::max(Clock::duration(0), due - Clock::now());
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
    timespec time{};
    time.tv_sec = seconds.count();
    time.tv_nsec = std::chrono::duration_cast<std::chrono::nanoseconds>(left - seconds).count();
    pollfd watched{descriptor_, POLLIN, 0};
    if (ppoll(&watched, 1, &time, nullptr) <= 0) return false;
    std::uint64_t count = 0;
    return ::read(descriptor_, &count, sizeof count) == sizeof count;
}

}  // namespace plab::daemon
