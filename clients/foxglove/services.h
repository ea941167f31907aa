/// Requests as services: one for each verb of server/docs/requests.md, and one for requests of several operations. What is asked and what
/// is answered is JSON, whose schemas clients get.
#pragma once

#include "foxglove/protocol.h"
#include "link/caller.h"

namespace plab::foxglove
{

Json advertise_services();
/// Null: there is none of this id.
const char* service_name(std::uint32_t service);
/// What a call asks for; an error says which member is wrong. `data`: JSON, or nothing for services that need no arguments.
Result<link::Request> request_of(std::uint32_t service, const std::string& data);

}  // namespace plab::foxglove
