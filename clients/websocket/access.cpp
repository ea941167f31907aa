#include "websocket/access.h"

#include <algorithm>
#include <random>

namespace plab::websocket
{
namespace
{

constexpr std::size_t kTokenBytes = 16;

std::string lower_case(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

}  // namespace

std::string make_token()
{
    std::random_device random;  // of the system or the processor: no sequence from a seed
    std::string out;
    for (std::size_t i = 0; i < kTokenBytes; ++i)
    {
        const unsigned byte = random() & 255u;
        out += "0123456789abcdef"[byte >> 4];
        out += "0123456789abcdef"[byte & 15u];
    }
    return out;
}

bool same_secret(std::string_view a, std::string_view b)
{
    if (a.size() != b.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
    return difference == 0;
}

Access::Access(AccessRules rules, int port) : rules_(std::move(rules))
{
    for (const std::string& host : rules_.hosts) hosts_.insert(lower_case(host) + ":" + std::to_string(port));
}

bool Access::has_token(std::string_view path) const
{
    if (path.empty() || path.front() != '/') return false;
    if (rules_.token.empty() || rules_.open.contains(std::string(path))) return true;
    path.remove_prefix(1);
    const std::size_t end = path.find('/');
    return end != std::string_view::npos && same_secret(path.substr(0, end), rules_.token);
}

std::optional<Refusal> Access::check_host(const RequestHead& head) const
{
    if (hosts_.contains(lower_case(head.host))) return {};
    return Refusal{403,
                   "This address is not one of " + rules_.program + "'s. Use the address that it printed, or start it with --host NAME."};
}

std::optional<Refusal> Access::check_token(const RequestHead& head) const
{
    if (has_token(head.path)) return {};
    return Refusal{403, "The address lacks the right token. Use the whole address that " + rules_.program + " printed when it started."};
}

std::optional<Refusal> Access::check_request(const RequestHead& head) const
{
    if (auto refusal = check_host(head)) return refusal;
    if (!head.origin.empty() && lower_case(head.origin) != "http://" + lower_case(head.host))
        return Refusal{403, "Another site's page asked for this. Only " + rules_.program + "'s own page may."};
    return check_token(head);
}

bool Access::may_open(const std::string& origin) const
{
    if (rules_.origins.contains(origin)) return true;
    const std::size_t colon = origin.rfind(':');
    if (colon == std::string::npos) return rules_.origins.contains(origin + ":*");  // a port that goes without saying
    const bool has_port = origin.find_first_not_of("0123456789", colon + 1) == std::string::npos;
    return rules_.origins.contains((has_port ? origin.substr(0, colon) : origin) + ":*");
}

std::optional<Refusal> Access::check_socket(const RequestHead& head) const
{
    if (auto refusal = check_host(head)) return refusal;
    const std::string origin = lower_case(head.origin);
    if (origin.empty() && !rules_.programs)
        return Refusal{403, "The socket is for " + rules_.program + "'s own page, and this request does not say which page it comes from."};
    if (!origin.empty() && origin != "http://" + lower_case(head.host) && !may_open(origin))
        return Refusal{403, "A page of " + head.origin + " asked for the socket, which is not among those that may."};
    return check_token(head);
}

std::string Access::below_token(const std::string& path) const
{
    const std::size_t skipped = rules_.token.empty() || rules_.open.contains(path) ? 1 : rules_.token.size() + 2;
    return path.size() < skipped ? std::string() : path.substr(skipped);
}

}  // namespace plab::websocket
