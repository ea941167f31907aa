#include "websocket/message.h"

#include <cstring>

namespace plab::websocket
{

Message::Message(std::string_view text) : bytes_(kFront + text.size())
{
    if (!text.empty()) std::memcpy(content(), text.data(), text.size());
}

Message Message::binary(std::size_t size)
{
    Message out;
    out.bytes_.resize(kFront + size);
    out.is_binary_ = true;
    return out;
}

Message Message::binary(std::string_view bytes)
{
    Message out(bytes);
    out.is_binary_ = true;
    return out;
}

}  // namespace plab::websocket
