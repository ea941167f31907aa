/// What browsers get from plab-web: the files of the page, its socket, and the figures for Prometheus.
#pragma once

#include <set>
#include <string>

#include "web/files.h"
#include "web/metrics_text.h"
#include "web/pages.h"

namespace plab::web
{

class PageService final : public websocket::Service
{
public:
    /// All of them must outlive it.
    PageService(const PageFiles& files, Pages& pages, const NewestFigures& figures) : files_(files), pages_(pages), figures_(figures) {}

    websocket::HttpAnswer get(const std::string& path) override;
    std::optional<PageId> join() override { return pages_.join(); }
    void leave(PageId page) override { pages_.leave(page); }
    std::optional<std::string> receive(PageId page, const std::string& bytes, bool is_binary) override;
    std::optional<websocket::Outgoing> take(PageId page) override;
    bool has_any(PageId page) const override { return pages_.has_any(page); }

private:
    const PageFiles& files_;
    Pages& pages_;
    const NewestFigures& figures_;
};

/// For websocket::Server: listens on `address`; `port` 0: any that is free. `hosts`: more names by which browsers reach it. The figures are
/// below the token; on loopback, where every program can read the bus as well, also without it.
websocket::ServerOptions page_server(const std::string& address, int port, std::set<std::string> hosts);

}  // namespace plab::web
