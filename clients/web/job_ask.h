/// What a page asks of plab-web itself, not of the server: recordings, playbacks, branches, and which server it looks at.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace plab::web
{

struct JobAsk
{
    std::uint64_t id = 0;  ///< the page's own number of the request
    std::string verb;      ///< README.md lists them
    std::string name;      ///< of a recording or a server
    double value = 0;      ///< s, of a seek; a rate; of a branch: 1, it begins paused
};

/// `server`: the one that the page looks at; "": there is none.
using JobHandler = std::function<void(std::uint64_t page, const JobAsk& ask, const std::string& server)>;

}  // namespace plab::web
