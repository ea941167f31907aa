/// Who may see the page. Its address has a random token, which every request must show; a request must have been made for an address at
/// which this program is reached, and by its own page.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace plab::web
{

/// 32 hexadecimal digits: 128 bits from the system's source of randomness.
std::string make_token();

/// Takes as long for any two texts of these lengths: what is right of a guess cannot be measured.
bool same_secret(std::string_view a, std::string_view b);

/// What a browser says of a request; absent headers are empty.
struct RequestHead
{
    std::string path;    ///< "/TOKEN/page.js"
    std::string host;    ///< header Host: the address that the user typed
    std::string origin;  ///< header Origin: the page that asks
};

struct Refusal
{
    int status = 0;        ///< of HTTP
    std::string sentence;  ///< for people
};

class Access
{
public:
    /// `hosts`: names and addresses, without port, at which this program may be reached.
    Access(std::string token, const std::set<std::string>& hosts, int port);

    /// Nothing: the file below the token may be sent. A foreign host name is refused even with the right token: a page of another site
    /// whose name was pointed at this address (DNS rebinding) cannot read it.
    std::optional<Refusal> check_request(const RequestHead& head) const;
    /// As above, for the socket: besides, the request must come from this program's page.
    std::optional<Refusal> check_socket(const RequestHead& head) const;
    /// "/TOKEN/page.js" is "page.js", and "/TOKEN/" is "". Only for a path that was checked.
    std::string below_token(const std::string& path) const;

    const std::string& token() const { return token_; }

private:
    bool has_token(std::string_view path) const;

    std::string token_;
    std::set<std::string> hosts_;  ///< with port
};

}  // namespace plab::web
