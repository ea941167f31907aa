/// The source of moments: a server, or a recording.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "viewer/moment_buffer.h"

namespace plab::view
{

class Source
{
public:
    Source() = default;
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;
    virtual ~Source() = default;

    /// The next moment; empty if none arrived until `timeout`, or if there are no more.
    virtual std::optional<Moment> pop(link::Seconds timeout) = 0;
    /// Why there are no more, once all moments are taken.
    virtual std::optional<std::string> closed() const = 0;
    /// Moments that were dropped because they were not taken in time.
    virtual std::uint64_t given_up() const = 0;
    /// The latest known scene and server.
    virtual std::shared_ptr<const link::CatalogueContents> scene() const = 0;
    /// The server's own status.
    virtual std::optional<link::ServerInfo> server() const = 0;
};

}  // namespace plab::view
