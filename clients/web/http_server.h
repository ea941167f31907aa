/// Serves the page and its socket. The only file of this client that knows libwebsockets.
#pragma once

#include <memory>
#include <set>
#include <string>

#include "plab/result.h"
#include "web/access.h"
#include "web/files.h"
#include "web/pages.h"

namespace plab::web
{

class HttpServer
{
public:
    /// Listens on `address`; `port` 0: any that is free. `hosts`: names by which browsers reach it, beside the address and, of loopback,
    /// localhost. Files and pages must outlive it.
    static Result<std::unique_ptr<HttpServer>> listen(const std::string& address, int port, std::set<std::string> hosts,
                                                      const PageFiles& files, Pages& pages);
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    /// "http://127.0.0.1:40123/3f../"
    std::string url() const;
    /// Serves until something happened; call it again and again.
    void step();
    /// Ends the current step(), which looks for new messages; from any thread and from signal handlers.
    void wake();

    struct State;  ///< known to the callbacks of libwebsockets

private:
    explicit HttpServer(std::unique_ptr<State> state);

    std::unique_ptr<State> state_;
};

}  // namespace plab::web
