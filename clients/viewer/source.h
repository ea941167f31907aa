/// Where moments come from, one after the other: a server, or a recording.
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

    /// The next moment; none when none came until `timeout`, or when there are no more.
    virtual std::optional<Moment> pop(link::Seconds timeout) = 0;
    /// Why there are no more, once all moments are taken.
    virtual std::optional<std::string> closed() const = 0;
    /// Moments that were left out because nobody took them.
    virtual std::uint64_t given_up() const = 0;
    /// The newest that is known of the scene and the server.
    virtual std::shared_ptr<const link::CatalogueContents> scene() const = 0;
    /// The server's own words on itself.
    virtual std::optional<link::ServerInfo> server() const = 0;
};

}  // namespace plab::view
