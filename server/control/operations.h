/// Requests in words, as clients send them, turned into operations. The words are described in server/docs/requests.md.
#pragma once

#include "model/type_registry.h"
#include "publish/records.h"
#include "simulation/requests/requests.h"

namespace plab::control
{

struct Wanted
{
    simulation::Request request;  ///< without id
    bool shutdown = false;        ///< the server is to end; then there are no operations
};

/// Checks words, names and numbers that need no scene; the rest is checked when the request takes effect. A <plab> that
/// is loaded is compiled here (its plugins are loaded), one that is added when the request takes effect.
/// Each error names the operation: "operation 2 (swap): needs an argument: the new type".
Result<Wanted> wanted_of(const publish::RequestText& text, model::TypeSource& types);

/// An operation in words again, for log lines and events.
struct Description
{
    std::string verb, target, argument;
};
Description description_of(const simulation::Operation& operation);

/// The words that mean the operation, as a client would send them; of those that plabd's command line knows (swap, set).
publish::OperationText text_of(const simulation::Operation& operation);

/// reset, load, restore, rewind.
bool begins_a_run(const std::vector<publish::OperationText>& operations);

/// "real" (1), "max" (0), or a factor of real time from 1e-6 to 1e9.
Result<double> parse_rate(const std::string& text);

}  // namespace plab::control
