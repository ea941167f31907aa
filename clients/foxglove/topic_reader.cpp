#include "foxglove/topic_reader.h"

namespace plab::foxglove
{

TopicReader::TopicReader(link::RawReader reader, const wire::Topic& topic)
    : reader_(std::move(reader)), peek_(recording::make_peek(topic)), keeps_(topic.delivery == wire::Delivery::Catalogue)
{
}

Result<TopicReader> TopicReader::open(const link::Session& session, const wire::Topic& topic)
{
    constexpr std::int32_t kFew = 4, kMany = 4096;
    const bool is_newest = topic.delivery == wire::Delivery::Catalogue || topic.delivery == wire::Delivery::Newest;
    auto reader = link::RawReader::open(session, topic, is_newest ? kFew : kMany);
    if (!reader) return reader.errors();
    return TopicReader(reader.take(), topic);
}

void TopicReader::take(const std::function<void(const Sample&)>& handle)
{
    constexpr int kMostBatches = 256;  // a writer that never pauses must not keep the caller in this function
    const auto pass_on = [&](const link::RawSample& raw)
    {
        Sample sample;
        sample.instance = raw.instance;
        const auto* const bytes = reinterpret_cast<const std::uint8_t*>(raw.bytes.data());
        if (raw.has_value)
        {
            if (const auto header = peek_->at({bytes, raw.bytes.size()})) sample.time = header->time;
            const std::string_view text(reinterpret_cast<const char*>(raw.bytes.data()), raw.bytes.size());
            sample.content = std::make_shared<Message>(Message::binary(text));
        }
        else
            sample.gone = recording::key_of_gone({bytes, raw.bytes.size()});
        handle(sample);
    };
    for (int i = 0; i < kMostBatches && reader_.take(pass_on) > 0; ++i) continue;
}

void TopicReader::keep(const Sample& sample, std::uint64_t time)
{
    if (sample.content == nullptr)
        kept_.erase(sample.instance);
    else if (keeps_)
        kept_[sample.instance] = {sample.content, time};
}

}  // namespace plab::foxglove
