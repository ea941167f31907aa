// plab-web by requests that a browser would not make; it needs no server for them.
#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "prometheus.h"
#include "support/process.h"

namespace plab::test
{
namespace
{

/// A folder that stands in for the page, which may not have been built.
std::string made_page()
{
    const std::string folder = scratch_file("page");
    std::filesystem::create_directories(folder);
    std::ofstream(folder + "/index.html") << "the page";
    std::ofstream(folder + "/page.js") << std::string(300000, 'j');
    std::ofstream(folder + "/page.css") << "css";
    return folder;
}

class Web
{
public:
    Web()
        : address_file_(scratch_file("address")),
          process_({program("plab-web"), "--page", made_page(), "--domain", "66", "--write-address", address_file_})
    {
        REQUIRE_MESSAGE(process_.wait_for("plab-web: http://", Milliseconds(10000)), process_.errors());
        std::ifstream in(address_file_);
        in >> url_;
        const std::size_t port = url_.find(':', 7), path = url_.find('/', 7);
        port_ = std::stoi(url_.substr(port + 1, path - port - 1));
        token_ = url_.substr(path + 1, url_.size() - path - 2);
    }
    std::string page(const std::string& name = {}) const { return "/" + token_ + "/" + name; }
    std::string host() const { return "127.0.0.1:" + std::to_string(port_); }
    int port() const { return port_; }
    const std::string& address_file() const { return address_file_; }
    Process& process() { return process_; }

    /// What is answered to these bytes, until the connection is quiet or closed.
    std::string send(const std::string& bytes, const std::string& until = {}) const
    {
        const int fd = socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in to{};
        to.sin_family = AF_INET, to.sin_port = htons(static_cast<std::uint16_t>(port_)), to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        REQUIRE(connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0);
        const timeval patience{3, 0};
        (void)setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        (void)!::write(fd, bytes.data(), bytes.size());
        std::string out;
        char buffer[4096];
        for (ssize_t n = 0; (until.empty() || out.find(until) == std::string::npos) && (n = ::read(fd, buffer, sizeof buffer)) > 0;)
            out.append(buffer, static_cast<std::size_t>(n));
        (void)close(fd);
        return out;
    }
    std::string get(const std::string& path, const std::string& headers) const
    {
        return send("GET " + path + " HTTP/1.1\r\n" + headers + "Connection: close\r\n\r\n");
    }
    /// The first line of the answer.
    std::string status(const std::string& path, const std::string& headers) const
    {
        const std::string answer = get(path, headers);
        return answer.substr(0, answer.find("\r\n"));
    }
    std::string open_socket(const std::string& path, const std::string& headers) const
    {
        const std::string answer = send("GET " + path + " HTTP/1.1\r\n" + headers +
                                            "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                                            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: plab-web-1\r\n\r\n",
                                        "\r\n\r\n");
        return answer.substr(0, answer.find("\r\n"));
    }

private:
    std::string address_file_;
    Process process_;
    std::string url_, token_;
    int port_ = 0;
};

}  // namespace

TEST_CASE("plab-web gives its page to whoever has the token, and nothing else to anybody")
{
    Web web;
    const std::string host = "Host: " + web.host() + "\r\n";
    CHECK(web.status(web.page(), host) == "HTTP/1.1 200 OK");
    CHECK(web.get(web.page(), host).ends_with("the page"));
    CHECK(web.get(web.page("page.js"), host).ends_with(std::string(300000, 'j')));
    CHECK(web.get(web.page(), host).find("content-security-policy: default-src 'none'") != std::string::npos);
    // Without the token, or with a wrong one of the same length.
    for (const std::string& path :
         {std::string("/"), std::string("/page.js"), "/" + std::string(32, '0') + "/", std::string("/index.html")})
        CHECK(web.status(path, host).starts_with("HTTP/1.1 403"));
    // Outside of the bundle.
    for (const char* name :
         {"../../../../etc/passwd", "%2e%2e/%2e%2e/etc/passwd", "..%2f..%2fetc%2fpasswd", "./../address", "page.js/..", "other.js"})
    {
        INFO(name);
        const std::string answer = web.get(web.page(name), host);
        CHECK_MESSAGE((answer.starts_with("HTTP/1.1 403") || answer.starts_with("HTTP/1.1 404")), answer.substr(0, 60));
        CHECK(answer.find("root:") == std::string::npos);
    }
    CHECK(web.send("POST " + web.page() + " HTTP/1.1\r\n" + host + "Content-Length: 1\r\nConnection: close\r\n\r\nx")
              .starts_with("HTTP/1.1 405"));
}

TEST_CASE("plab-web refuses foreign hosts and origins, on the page and on the socket")
{
    Web web;
    const std::string host = "Host: " + web.host() + "\r\n", origin = "Origin: http://" + web.host() + "\r\n";
    CHECK(web.status(web.page(), "Host: evil.example\r\n").starts_with("HTTP/1.1 403"));
    CHECK(web.status(web.page(), host + "Origin: http://evil.example\r\n").starts_with("HTTP/1.1 403"));
    CHECK(web.open_socket(web.page("socket"), host + origin) == "HTTP/1.1 101 Switching Protocols");
    CHECK(web.open_socket(web.page("socket"), host).find("101") == std::string::npos);
    CHECK(web.open_socket(web.page("socket"), host + "Origin: http://evil.example\r\n").find("101") == std::string::npos);
    CHECK(web.open_socket(web.page("socket"), "Host: evil.example\r\nOrigin: http://evil.example\r\n").find("101") == std::string::npos);
    CHECK(web.open_socket("/" + std::string(32, '0') + "/socket", host + origin).find("101") == std::string::npos);
    CHECK(web.open_socket("/socket", host + origin).find("101") == std::string::npos);
    CHECK(web.open_socket(web.page(), host + origin).find("101") == std::string::npos);
}

TEST_CASE("figures for Prometheus are read without the token on this machine, by no other site")
{
    Web web;
    const std::string host = "Host: " + web.host() + "\r\n";
    for (const std::string& path : {std::string("/metrics"), web.page("metrics")})
    {
        const std::string answer = web.get(path, host);
        REQUIRE(answer.starts_with("HTTP/1.1 200 OK"));
        CHECK(answer.find("content-type: text/plain; version=0.0.4; charset=utf-8") != std::string::npos);
        prometheus::Reader reader;
        const auto families = reader.read(answer.substr(answer.find("\r\n\r\n") + 4));
        CHECK_MESSAGE(reader.error().empty(), reader.error());
        CHECK(families.at("plab_up").series.at(0).value == 0);  // no server is there
    }
    CHECK(web.status("/metrics", "Host: evil.example\r\n").starts_with("HTTP/1.1 403"));
    CHECK(web.status("/metrics", host + "Origin: http://evil.example\r\n").starts_with("HTTP/1.1 403"));
    CHECK(web.open_socket("/metrics", host + "Origin: http://" + web.host() + "\r\n").find("101") == std::string::npos);
}

TEST_CASE("only its owner can read the address, which goes with the program")
{
    Web web;
    struct stat facts
    {
    };
    REQUIRE(stat(web.address_file().c_str(), &facts) == 0);
    CHECK((facts.st_mode & 0777) == 0600);
    web.process().signal(15);
    CHECK(web.process().wait(Milliseconds(5000)) == 143);
    CHECK(stat(web.address_file().c_str(), &facts) != 0);
}

TEST_CASE("it listens on loopback alone, and says why it cannot listen")
{
    Web web;
    std::ifstream table("/proc/net/tcp");
    std::ostringstream port;
    port << ":" << std::uppercase << std::hex << web.port();
    bool is_found = false;
    for (std::string line; std::getline(table, line);)
    {
        std::istringstream words(line);
        std::string number, local, remote, state;
        words >> number >> local >> remote >> state;
        if (state != "0A" || !local.ends_with(port.str())) continue;
        is_found = true;
        CHECK(local.starts_with("0100007F"));
    }
    CHECK(is_found);
    const Outcome taken = run({program("plab-web"), "--page", made_page(), "--domain", "66", "--port", std::to_string(web.port())});
    CHECK(taken.code == 1);
    CHECK(taken.errors.find("cannot listen on 127.0.0.1") != std::string::npos);
}

TEST_CASE("a page that was not built is an error that says why")
{
    const std::string folder = scratch_file("no_page");
    std::filesystem::create_directories(folder);
    std::ofstream(folder + "/not_built.txt") << "there is no npm (Debian's package npm)\n";
    const Outcome outcome = run({program("plab-web"), "--page", folder});
    CHECK(outcome.code == 1);
    CHECK(outcome.errors.find("the page is not there") != std::string::npos);
    CHECK(outcome.errors.find("there is no npm") != std::string::npos);
}

}  // namespace plab::test
