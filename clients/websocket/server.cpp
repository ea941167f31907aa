#include "websocket/server.h"

#include <libwebsockets.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace plab::websocket
{

static_assert(Message::kFront >= LWS_PRE + Outgoing::kMostHead, "libwebsockets writes its head before the content");

/// What libwebsockets keeps for one connection, zero at first.
struct Visit
{
    std::shared_ptr<const File>* file;  ///< being sent
    std::size_t sent;
    std::string* text;        ///< of a message that arrives in pieces
    ConnectionId connection;  ///< 0: no socket
};

struct Server::State
{
    ServerOptions options;
    Service* service = nullptr;
    std::optional<Access> access;
    std::vector<lws_protocols> protocols;  ///< HTTP, those of the socket, and an empty one
    lws_context* context = nullptr;
    lws_vhost* vhost = nullptr;
};

namespace
{

constexpr std::size_t kPiece = 32u << 10;  ///< bytes of a file that are handed over at a time

Server::State& state_of(lws* wsi) { return *static_cast<Server::State*>(lws_context_user(lws_get_context(wsi))); }

std::string header(lws* wsi, lws_token_indexes name)
{
    const int length = lws_hdr_total_length(wsi, name);
    if (length <= 0) return {};
    std::string out(static_cast<std::size_t>(length) + 1, '\0');
    const int copied = lws_hdr_copy(wsi, out.data(), length + 1, name);
    out.resize(copied > 0 ? static_cast<std::size_t>(copied) : 0);
    return out;
}

RequestHead head_of(lws* wsi) { return {header(wsi, WSI_TOKEN_GET_URI), header(wsi, WSI_TOKEN_HOST), header(wsi, WSI_TOKEN_ORIGIN)}; }

/// Collects header lines in a buffer of its own.
class Head
{
public:
    Head(lws* wsi, int status, const std::string& type, std::size_t length)
        : wsi_(wsi), at_(bytes_.data() + LWS_PRE), end_(bytes_.data() + bytes_.size() - 1)
    {
        ok_ = lws_add_http_common_headers(wsi, static_cast<unsigned>(status), type.c_str(), length, &at_, end_) == 0;
        // Nothing of the page may be kept, framed, embedded elsewhere, or load anything from elsewhere.
        add("cache-control:", "no-store");
        add("content-security-policy:",
            "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self'; "
            "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
        add("x-content-type-options:", "nosniff");
        add("referrer-policy:", "no-referrer");
        add("cross-origin-resource-policy:", "same-origin");
        add("cross-origin-opener-policy:", "same-origin");
    }
    bool send() { return ok_ && lws_finalize_write_http_header(wsi_, bytes_.data() + LWS_PRE, &at_, end_) == 0; }

private:
    void add(const char* name, const std::string& value)
    {
        ok_ = ok_ && lws_add_http_header_by_name(wsi_, reinterpret_cast<const unsigned char*>(name),
                                                 reinterpret_cast<const unsigned char*>(value.data()), static_cast<int>(value.size()), &at_,
                                                 end_) == 0;
    }
    lws* wsi_;
    std::array<unsigned char, LWS_PRE + 2048> bytes_{};
    unsigned char *at_, *end_;
    bool ok_ = false;
};

int send(lws* wsi, Visit& visit, int status, std::shared_ptr<const File> file)
{
    delete visit.file;
    visit.file = new std::shared_ptr<const File>(std::move(file));
    visit.sent = 0;
    if (!Head(wsi, status, (*visit.file)->type, (*visit.file)->bytes.size()).send()) return -1;
    lws_callback_on_writable(wsi);
    return 0;
}

int refuse(lws* wsi, Visit& visit, const Refusal& refusal)
{
    const std::string text = state_of(wsi).options.access.program + ": " + refusal.sentence + "\n";
    return send(wsi, visit, refusal.status, std::make_shared<const File>(File{"text/plain; charset=utf-8", text}));
}

int answer(lws* wsi, Visit& visit)
{
    Server::State& state = state_of(wsi);
    const RequestHead head = head_of(wsi);
    if (head.path.empty()) return refuse(wsi, visit, {405, "Only GET is answered."});
    if (const auto refusal = state.access->check_request(head)) return refuse(wsi, visit, *refusal);
    const HttpAnswer answer = state.service->get(state.access->below_token(head.path));
    if (const auto* refusal = std::get_if<Refusal>(&answer)) return refuse(wsi, visit, *refusal);
    return send(wsi, visit, 200, std::get<std::shared_ptr<const File>>(answer));
}

/// The next piece of what is being sent.
int send_piece(lws* wsi, Visit& visit)
{
    if (visit.file == nullptr) return 0;
    const std::string* const bytes = &(*visit.file)->bytes;
    const std::size_t count = std::min(kPiece, bytes->size() - visit.sent);
    const bool is_last = visit.sent + count == bytes->size();
    std::vector<unsigned char> piece(LWS_PRE + count);
    std::memcpy(piece.data() + LWS_PRE, bytes->data() + visit.sent, count);
    if (lws_write(wsi, piece.data() + LWS_PRE, count, is_last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < 0) return -1;
    visit.sent += count;
    if (!is_last)
    {
        lws_callback_on_writable(wsi);
        return 0;
    }
    delete std::exchange(visit.file, nullptr);
    return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
}

void forget(Visit* visit)
{
    if (visit == nullptr) return;
    delete std::exchange(visit->text, nullptr);
    delete std::exchange(visit->file, nullptr);
}

int on_http(lws* wsi, lws_callback_reasons why, void* user, void* in, std::size_t length)
{
    auto* const visit = static_cast<Visit*>(user);
    switch (why)
    {
        case LWS_CALLBACK_HTTP:
            return answer(wsi, *visit);
        case LWS_CALLBACK_HTTP_WRITEABLE:
            return send_piece(wsi, *visit);
        case LWS_CALLBACK_CLOSED_HTTP:
            forget(visit);
            return 0;
        case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
            return -1;  // a socket that does not name its protocol
        case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
            for (std::size_t i = 1; i + 1 < state_of(wsi).protocols.size(); ++i)
                lws_callback_on_writable_all_protocol(lws_get_context(wsi), &state_of(wsi).protocols[i]);
            return 0;
        default:
            return lws_callback_http_dummy(wsi, why, user, in, length);
    }
}

// ---- The socket -----------------------------------------------------------------------------------------------------

/// An address without its last '/' is the same one.
std::string below_token(const Server::State& state, std::string path)
{
    if (!path.ends_with('/')) path += '/';
    std::string out = state.access->below_token(path);
    if (!out.empty()) out.pop_back();
    return out;
}

bool may_open(lws* wsi)
{
    Server::State& state = state_of(wsi);
    RequestHead head = head_of(wsi);
    if (!head.path.ends_with('/')) head.path += '/';
    return !state.access->check_socket(head) && below_token(state, head.path) == state.options.socket_path;
}

int close_with(lws* wsi, lws_close_status status, const char* sentence)
{
    lws_close_reason(wsi, status, reinterpret_cast<unsigned char*>(const_cast<char*>(sentence)), std::strlen(sentence));
    return -1;
}

int receive(lws* wsi, Visit& visit, const void* in, std::size_t length)
{
    Server::State& state = state_of(wsi);
    if (lws_is_first_fragment(wsi) && visit.text != nullptr) visit.text->clear();
    if (visit.text == nullptr) visit.text = new std::string;
    if (visit.text->size() + length > state.options.most_received)
        return close_with(wsi, LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE, "the message is too long");
    visit.text->append(static_cast<const char*>(in), length);
    if (!lws_is_final_fragment(wsi) || lws_remaining_packet_payload(wsi) > 0) return 0;
    const auto why_not = state.service->receive(visit.connection, *visit.text, lws_frame_is_binary(wsi) != 0);
    if (why_not) return close_with(wsi, LWS_CLOSE_STATUS_POLICY_VIOLATION, why_not->c_str());
    if (state.service->has_any(visit.connection)) lws_callback_on_writable(wsi);
    visit.text->clear();
    return 0;
}

int send_message(lws* wsi, const Visit& visit)
{
    Server::State& state = state_of(wsi);
    const auto out = state.service->take(visit.connection);
    if (!out) return 0;
    if (out->message == nullptr) return close_with(wsi, LWS_CLOSE_STATUS_POLICY_VIOLATION, "too much waits for this client");
    const auto kind = out->message->is_binary() ? LWS_WRITE_BINARY : LWS_WRITE_TEXT;
    // Other connections write their heads to the same bytes, one after the other.
    unsigned char* const begin = out->message->content() - out->head_size;
    const std::size_t size = out->head_size + out->message->size();
    std::copy_n(out->head.begin(), out->head_size, begin);
    if (lws_write(wsi, begin, size, kind) < static_cast<int>(size)) return -1;
    if (state.service->has_any(visit.connection)) lws_callback_on_writable(wsi);
    return 0;
}

int on_socket(lws* wsi, lws_callback_reasons why, void* user, void* in, std::size_t length)
{
    auto* const visit = static_cast<Visit*>(user);
    switch (why)
    {
        case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
            return may_open(wsi) ? 0 : -1;
        case LWS_CALLBACK_ESTABLISHED:
        {
            *visit = {};
            const auto connection = state_of(wsi).service->join();
            if (!connection) return close_with(wsi, LWS_CLOSE_STATUS_POLICY_VIOLATION, "too many sockets are open");
            visit->connection = *connection;
            if (state_of(wsi).service->has_any(*connection)) lws_callback_on_writable(wsi);
            return 0;
        }
        case LWS_CALLBACK_RECEIVE:
            return receive(wsi, *visit, in, length);
        case LWS_CALLBACK_SERVER_WRITEABLE:
            return send_message(wsi, *visit);
        case LWS_CALLBACK_CLOSED:
            if (visit->connection != 0) state_of(wsi).service->leave(visit->connection);
            forget(visit);
            return 0;
        default:
            return 0;
    }
}

std::string& log_text()
{
    static std::string text;
    return text;
}

void keep_log(int, const char* line) { log_text() = line; }

}  // namespace

Server::Server(std::unique_ptr<State> state) : state_(std::move(state)) {}

Server::~Server()
{
    if (state_->context != nullptr) lws_context_destroy(state_->context);
}

bool is_loopback(const std::string& address) { return address.starts_with("127."); }

Result<std::unique_ptr<Server>> Server::listen(ServerOptions options, Service& service)
{
    std::unique_ptr<Server> out(new Server(std::make_unique<State>()));
    State& state = *out->state_;
    state.options = std::move(options), state.service = &service;
    state.protocols.push_back({"http", &on_http, sizeof(Visit), 0, 0, nullptr, 0});
    for (const std::string& name : state.options.protocols)
        state.protocols.push_back({name.c_str(), &on_socket, sizeof(Visit), 4096, 0, nullptr, 0});
    state.protocols.push_back({});
    const std::string& address = state.options.address;
    lws_set_log_level(LLL_ERR, &keep_log);
    lws_context_creation_info info{};
    info.port = state.options.port;
    info.iface = address.c_str();
    info.protocols = state.protocols.data();
    info.gid = static_cast<gid_t>(-1), info.uid = static_cast<uid_t>(-1);
    info.user = &state;
    info.options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS | LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND | LWS_SERVER_OPTION_DISABLE_IPV6;
    info.ka_time = 30, info.ka_probes = 3, info.ka_interval = 10;  // s: a client whose machine is gone is forgotten
    state.context = lws_create_context(&info);
    if (state.context == nullptr) return reason("cannot start libwebsockets: " + log_text());
    state.vhost = lws_create_vhost(state.context, &info);
    if (state.vhost == nullptr)
        return reason("cannot listen on " + address + ", port " + std::to_string(state.options.port) +
                      ": the address is not of this machine, or the port is taken");
    AccessRules rules = state.options.access;
    rules.hosts.insert(address);
    if (is_loopback(address)) rules.hosts.insert("localhost");
    state.access.emplace(std::move(rules), lws_get_vhost_listen_port(state.vhost));
    return out;
}

std::string Server::url(const std::string& scheme) const
{
    const std::string& token = state_->access->token();
    return scheme + "://" + state_->options.address + ":" + std::to_string(lws_get_vhost_listen_port(state_->vhost)) + "/" + token +
           (token.empty() ? "" : "/");
}

void Server::step() { (void)lws_service(state_->context, 0); }

void Server::wake() { lws_cancel_service(state_->context); }

}  // namespace plab::websocket
