#include "web/page_service.h"

#include "web/translate.h"

namespace plab::web
{
namespace
{

constexpr const char* kMetrics = "metrics";

}  // namespace

websocket::HttpAnswer PageService::get(const std::string& path)
{
    if (path == kMetrics)
    {
        const auto figures = figures_.get();
        return std::make_shared<const websocket::File>(websocket::File{kMetricsType, metrics_text(figures.get(), pages_.figures())});
    }
    if (auto file = files_.find(path)) return file;
    return websocket::Refusal{404, "The page has no such file."};
}

std::optional<std::string> PageService::receive(PageId page, const std::string& bytes, bool)
{
    // One byte: poses were drawn.
    if (bytes.size() == 1)
        pages_.acknowledge(page);
    else if (!pages_.receive(page, bytes))
        return "too many messages wait";
    return {};
}

std::optional<websocket::Outgoing> PageService::take(PageId page)
{
    MessagePtr message = pages_.take(page);
    if (message == nullptr) return {};
    return websocket::Outgoing{std::move(message), {}, 0};
}

websocket::ServerOptions page_server(const std::string& address, int port, std::set<std::string> hosts)
{
    websocket::ServerOptions out;
    out.address = address, out.port = port;
    out.access.program = "plab-web";
    out.access.token = websocket::make_token();
    out.access.hosts = std::move(hosts);
    if (websocket::is_loopback(address)) out.access.open.insert(std::string("/") + kMetrics);
    out.socket_path = "socket", out.protocols = {"plab-web-1"};
    out.most_received = kMostText;
    return out;
}

}  // namespace plab::web
