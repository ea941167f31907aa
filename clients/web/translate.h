/// The one place where what a server says becomes JSON for the page, and what the page says becomes requests. README.md lists the
/// messages.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "idl/json/json.h"
#include "link/caller.h"
#include "link/catalogue.h"
#include "web/job_ask.h"
#include "web/outbox.h"

namespace plab::web
{

using wire::Json;

/// As text, for pages.
MessagePtr message_of(const Json& json);
/// The whole scene, without the parameters of each component: these are sent for those that are looked at.
Json scene_message(const link::CatalogueContents& now);
/// What differs from `before`; nothing: no difference that the page shows.
std::optional<Json> changes_message(const link::CatalogueContents& before, const link::CatalogueContents& now);
Json server_message(const link::ServerInfo& server);
/// One row for each interaction; all outputs of the components in `watched`.
Json metrics_message(const link::Metrics& metrics, const std::set<std::string>& watched);
/// Everything about one component, with its parameters.
Json detail_message(const link::CatalogueContents& now, const std::string& component);
Json reply_message(std::uint64_t id, const link::Reply& reply);
/// `preview`: as plabctl prints it.
Json preview_message(std::uint64_t id, const Json& preview);
/// An answer that is not the server's.
Json refusal_message(std::uint64_t id, const std::string& reason);

// What a page says.
struct Ask
{
    std::uint64_t id = 0;  ///< the page's own number of the request
    link::Request request;
};
struct Watch
{
    std::set<std::string> components;
};
struct Grab
{
    std::uint64_t id = 0;
    std::string body;
    Vec3 position;       ///< W, m
    double force = 100;  ///< N, largest
};
struct MoveHand
{
    Vec3 position;  ///< W, m
};
struct Release
{
};
/// What would an exchange do?
struct PreviewAsk
{
    std::uint64_t id = 0;
    std::string component, type;
    double seconds = 1;  ///< simulated
};
/// The next contacts.
struct ContactsAsk
{
};
using Said = std::variant<Ask, Watch, ContactsAsk, Grab, MoveHand, Release, PreviewAsk, JobAsk>;

inline constexpr std::size_t kMostText = 256u << 10;  ///< bytes of a message from a page
inline constexpr std::size_t kMostWatched = 16;       ///< components of a page

/// An error says which member is wrong.
Result<Said> parse_said(const std::string& text);

}  // namespace plab::web
