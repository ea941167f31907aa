/// One message of a web socket, made once for all connections that get it.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

namespace plab::websocket
{

class Message
{
public:
    /// Bytes before the content that whoever sends it may use.
    static constexpr std::size_t kFront = 48;

    explicit Message(std::string_view text);
    /// Of `size` bytes, all zero.
    static Message binary(std::size_t size);
    static Message binary(std::string_view bytes);

    bool is_binary() const { return is_binary_; }
    std::size_t size() const { return bytes_.size() - kFront; }
    /// The content; the kFront bytes before it may be written.
    unsigned char* content() { return bytes_.data() + kFront; }
    const unsigned char* content() const { return bytes_.data() + kFront; }

private:
    Message() = default;

    std::vector<unsigned char> bytes_;
    bool is_binary_ = false;
};
using MessagePtr = std::shared_ptr<Message>;

/// A message for one connection: bytes that are only this connection's go before a content that all share.
struct Outgoing
{
    static constexpr std::size_t kMostHead = 16;

    MessagePtr message;
    std::array<unsigned char, kMostHead> head{};
    std::size_t head_size = 0;
};

}  // namespace plab::websocket
