/// Converts the text of requests, as clients send them, to operations. The text is described in server/docs/requests.md.
#pragma once

#include <optional>

#include "idl/values/values.h"
#include "model/compile.h"
#include "simulation/requests/requests.h"

namespace plab::control
{

struct Wanted
{
    simulation::Request request;  ///< without id
    bool shutdown = false;        ///< the server is to shut down; then there are no operations
    struct Cancelled
    {
        wire::ClientId client{};
        std::uint64_t number = 0;
    };
    std::optional<Cancelled> cancel;  ///< a waiting request is cancelled; then there are no operations
};

/// Checks everything that needs no scene: verbs, names and numbers. The rest is checked when the request takes effect. A <plab>
/// to load is compiled here (and its plugins are loaded); for one to add see preparation.h. Each error
/// names the operation: "operation 2 (swap): needs an argument: the new type".
Result<Wanted> wanted_of(const wire::Request& text, model::TypeSource& types, const model::CompileLimits& limits = {});

/// Text of an operation for log lines and events.
struct Description
{
    std::string verb, target, argument;
};
Description description_of(const simulation::Operation& operation);

/// The text of the operation as a client would send it, for the operations that plabd's command line has (swap, set).
wire::Operation text_of(const simulation::Operation& operation);

/// Whether the operation begins a new run: reset, load, restore, rewind.
bool begins_a_run(const std::vector<wire::Operation>& operations);

/// "none", "20 ms", "20 ms or refuse", "or refuse", "unlimited": how a swap is tested.
Result<simulation::TrialChoice> parse_trial(const std::string& text);

/// "3f..00:7", 32 hexadecimal digits and a number: identifies one request of one client.
Result<Wanted::Cancelled> parse_request_name(const std::string& text);

/// "real" (1), "max" (0), or a factor of real time from 1e-6 to 1e9.
Result<double> parse_rate(const std::string& text);

}  // namespace plab::control
