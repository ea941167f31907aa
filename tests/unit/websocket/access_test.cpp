#include "websocket/access.h"

#include <doctest/doctest.h>

using namespace plab::websocket;

namespace
{

const Access& access()
{
    static const Access made(
        AccessRules{"plab-web", "0123456789abcdef0123456789abcdef", {"127.0.0.1", "localhost"}, {}, {"/metrics"}, false}, 8080);
    return made;
}

RequestHead head(const std::string& path, const std::string& host = "127.0.0.1:8080", const std::string& origin = {})
{
    return {path, host, origin};
}

constexpr const char* kPage = "/0123456789abcdef0123456789abcdef/";

int status_of(const std::optional<Refusal>& refusal) { return refusal ? refusal->status : 200; }

}  // namespace

TEST_CASE("tokens have 128 bits and differ")
{
    const std::string a = make_token(), b = make_token();
    CHECK(a.size() == 32);
    CHECK(a.find_first_not_of("0123456789abcdef") == std::string::npos);
    CHECK(a != b);
}

TEST_CASE("a request needs the whole token, at its place")
{
    CHECK(status_of(access().check_request(head(kPage))) == 200);
    CHECK(status_of(access().check_request(head(std::string(kPage) + "page.js"))) == 200);
    for (const char* path :
         {"", "/", "//", "/page.js", "/0123456789abcdef0123456789abcdef", "/0123456789abcdef0123456789abcdeX/", "/0123456789abcdef/",
          "/x/0123456789abcdef0123456789abcdef/", "0123456789abcdef0123456789abcdef/", "/0123456789ABCDEF0123456789ABCDEF/"})
    {
        INFO(path);
        CHECK(status_of(access().check_request(head(path))) == 403);
        CHECK(status_of(access().check_socket(head(path, "127.0.0.1:8080", "http://127.0.0.1:8080"))) == 403);
    }
}

TEST_CASE("a request for another host is refused: a name that was pointed here reads nothing")
{
    CHECK(status_of(access().check_request(head(kPage, "localhost:8080"))) == 200);
    CHECK(status_of(access().check_request(head(kPage, "LOCALHOST:8080"))) == 200);
    for (const char* host :
         {"", "evil.example:8080", "127.0.0.1", "127.0.0.1:8081", "localhost.evil.example:8080", "127.0.0.1:8080.evil.example"})
    {
        INFO(host);
        CHECK(status_of(access().check_request(head(kPage, host))) == 403);
    }
}

TEST_CASE("the socket is for the page alone")
{
    CHECK(status_of(access().check_socket(head(kPage, "127.0.0.1:8080", "http://127.0.0.1:8080"))) == 200);
    CHECK(status_of(access().check_socket(head(kPage, "localhost:8080", "http://localhost:8080"))) == 200);
    for (const char* origin :
         {"", "null", "http://evil.example", "http://127.0.0.1:9090", "https://127.0.0.1:8080", "http://localhost:8080"})
    {
        INFO(origin);
        CHECK(status_of(access().check_socket(head(kPage, "127.0.0.1:8080", origin))) == 403);
    }
    // A page elsewhere that loads a file of ours says where it comes from.
    CHECK(status_of(access().check_request(head(kPage, "127.0.0.1:8080", "http://evil.example"))) == 403);
}

TEST_CASE("what is below the token is a name of the bundle, never a path")
{
    CHECK(access().below_token(kPage).empty());
    CHECK(access().below_token(std::string(kPage) + "page.js") == "page.js");
    CHECK(access().below_token(std::string(kPage) + "../../etc/passwd") == "../../etc/passwd");  // no name that the bundle has
}

TEST_CASE("a path that is open needs no token, but still the right host and no foreign page")
{
    CHECK(status_of(access().check_request(head("/metrics"))) == 200);
    CHECK(access().below_token("/metrics") == "metrics");
    CHECK(access().below_token(std::string(kPage) + "metrics") == "metrics");
    CHECK(status_of(access().check_request(head("/metrics/"))) == 403);
    CHECK(status_of(access().check_request(head("/metrics", "evil.example:8080"))) == 403);
    CHECK(status_of(access().check_request(head("/metrics", "127.0.0.1:8080", "http://evil.example"))) == 403);
}

TEST_CASE("without a token, the origin says which pages may open the socket; programs send none")
{
    const Access open(AccessRules{"plab-foxglove", "", {"localhost"}, {"https://app.example", "http://localhost:*"}, {}, true}, 8765);
    const auto status = [&](const std::string& origin) { return status_of(open.check_socket(head("/", "localhost:8765", origin))); };
    for (const char* origin : {"", "https://app.example", "HTTPS://App.Example", "http://localhost:3000", "http://localhost"})
    {
        INFO(origin);
        CHECK(status(origin) == 200);
    }
    for (const char* origin :
         {"null", "http://app.example", "https://app.example.evil.example", "https://localhost:3000", "http://localhost.evil.example:3000",
          "http://localhost:3000.evil.example", "http://localhost:x", "https://app.example:8443", "http://localhost:30:40"})
    {
        INFO(origin);
        CHECK(status(origin) == 403);
    }
    CHECK(status_of(open.check_socket(head("/", "evil.example:8765"))) == 403);
    CHECK(open.below_token("/").empty());
    CHECK(open.below_token("/x") == "x");
}
