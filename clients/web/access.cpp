#include "web/access.h"

#include <algorithm>
#include <random>

namespace plab::web
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

Access::Access(std::string token, const std::set<std::string>& hosts, int port) : token_(std::move(token))
{
    for (const std::string& host : hosts) hosts_.insert(lower_case(host) + ":" + std::to_string(port));
}

bool Access::has_token(std::string_view path) const
{
    if (path.empty() || path.front() != '/') return false;
    path.remove_prefix(1);
    const std::size_t end = path.find('/');
    return end != std::string_view::npos && same_secret(path.substr(0, end), token_);
}

std::optional<Refusal> Access::check_request(const RequestHead& head) const
{
    const std::string host = lower_case(head.host);
    if (!hosts_.contains(host))
        return Refusal{403, "This address is not one of plab-web's. Use the address that it printed, or start it with --host NAME."};
    if (!head.origin.empty() && lower_case(head.origin) != "http://" + host)
        return Refusal{403, "Another site's page asked for this. Only plab-web's own page may."};
    if (!has_token(head.path))
        return Refusal{403, "The address lacks the right token. Use the whole address that plab-web printed when it started."};
    return {};
}

std::optional<Refusal> Access::check_socket(const RequestHead& head) const
{
    if (auto refusal = check_request(head)) return refusal;
    if (head.origin.empty())
        return Refusal{403, "The socket is for plab-web's own page, and this request does not say which page it comes from."};
    return {};
}

std::string Access::below_token(const std::string& path) const
{
    return path.size() < token_.size() + 2 ? std::string() : path.substr(token_.size() + 2);
}

}  // namespace plab::web
