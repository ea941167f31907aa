/// Reserves a server's name on a host (within a network namespace) for the lifetime of the process.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "plab/result.h"

namespace plab::wire
{

/// An abstract unix socket of that name. The kernel releases it when the process ends, however it ends.
class NameLock
{
public:
    NameLock() = default;
    NameLock(NameLock&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
    NameLock& operator=(NameLock&& other) noexcept
    {
        std::swap(socket_, other.socket_);
        return *this;
    }
    NameLock(const NameLock&) = delete;
    NameLock& operator=(const NameLock&) = delete;
    ~NameLock();

    /// The error names the process that has it, if that is known.
    static Result<NameLock> take(std::uint32_t domain, const std::string& name);

private:
    explicit NameLock(int socket) : socket_(socket) {}

    int socket_ = -1;
};

}  // namespace plab::wire
