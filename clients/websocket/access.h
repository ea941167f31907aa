/// Who may connect. An address may have a random token, which every request must show; a request must have been made for an address at
/// which this program is reached, and a socket must be opened by a page that may do so.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace plab::websocket
{

/// 32 hexadecimal digits: 128 bits from the system's source of randomness.
std::string make_token();

/// Takes as long for any two texts of these lengths: what is right of a guess cannot be measured.
bool same_secret(std::string_view a, std::string_view b);

/// What a client says of a request; absent headers are empty.
struct RequestHead
{
    std::string path;    ///< "/TOKEN/page.js"
    std::string host;    ///< header Host: the address that the user typed
    std::string origin;  ///< header Origin: the page that asks; programs send none
};

struct Refusal
{
    int status = 0;        ///< of HTTP
    std::string sentence;  ///< for people
};

struct AccessRules
{
    std::string program;          ///< "plab-web", for sentences
    std::string token;            ///< empty: none is needed
    std::set<std::string> hosts;  ///< names and addresses, without port, at which this program may be reached
    std::set<std::string>
        origins;                 ///< pages beside its own that may open the socket: "https://app.example"; "http://localhost:*": any port
    std::set<std::string> open;  ///< paths that need no token: "/metrics"
    bool programs = false;       ///< who sends no origin may open the socket
};

class Access
{
public:
    Access(AccessRules rules, int port);

    /// Nothing: what is below the token may be sent. A foreign host name is refused even with the right token: a page of another site
    /// whose name was pointed at this address (DNS rebinding) cannot read it.
    std::optional<Refusal> check_request(const RequestHead& head) const;
    /// As above, for the socket: besides, the request must come from a page, or a program, that may open it.
    std::optional<Refusal> check_socket(const RequestHead& head) const;
    /// "/TOKEN/page.js" is "page.js", and "/TOKEN/" is "". Only for a path that was checked.
    std::string below_token(const std::string& path) const;

    const std::string& token() const { return rules_.token; }

private:
    std::optional<Refusal> check_host(const RequestHead& head) const;
    std::optional<Refusal> check_token(const RequestHead& head) const;
    bool has_token(std::string_view path) const;
    bool may_open(const std::string& origin) const;

    AccessRules rules_;
    std::set<std::string> hosts_;  ///< with port
};

}  // namespace plab::websocket
