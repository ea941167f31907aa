/// One entry of the log as one line of text.
#pragma once

#include <memory>
#include <string>

#include "link/session.h"

namespace plab::logger
{

/// Numbers that never arrived: `missed` entries from `first` on.
struct Gap
{
    const char* topic = "";
    std::uint64_t first = 0, missed = 0;
};

enum class ServerChange : unsigned char
{
    Found,
    Gone,
    Back,  ///< the same server, or another process under its name
};

class Lines
{
public:
    virtual ~Lines() = default;
    virtual std::string event(const plab_v2_Events& sample, std::uint32_t index) const = 0;
    virtual std::string collision(const plab_v2_Collisions& sample, std::uint32_t index) const = 0;
    virtual std::string metrics(const plab_v2_Metrics& sample) const = 0;
    virtual std::string status(const plab_v2_Server& sample) const = 0;
    virtual std::string gap(const Gap& gap) const = 0;
    virtual std::string run(std::uint64_t run) const = 0;
    virtual std::string server(ServerChange change, const link::ServerInfo& info) const = 0;
};

std::unique_ptr<Lines> make_human_lines();
std::unique_ptr<Lines> make_json_lines();

}  // namespace plab::logger
