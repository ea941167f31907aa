/// DDS entities as C++ values: they close themselves, and readers and writers are typed.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "idl/topics.h"
#include "plab/result.h"

namespace plab::wire
{

/// Owns one DDS entity and everything created from it.
class Entity
{
public:
    Entity() = default;
    explicit Entity(dds_entity_t handle) : handle_(handle) {}
    Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
    Entity& operator=(Entity&& other) noexcept
    {
        if (this != &other) reset(), handle_ = std::exchange(other.handle_, 0);
        return *this;
    }
    Entity(const Entity&) = delete;
    Entity& operator=(const Entity&) = delete;
    ~Entity() { reset(); }

    dds_entity_t get() const { return handle_; }
    bool valid() const { return handle_ > 0; }
    void reset()
    {
        if (handle_ > 0) (void)dds_delete(handle_);
        handle_ = 0;
    }

private:
    dds_entity_t handle_ = 0;
};

inline Error failed(const std::string& what, dds_return_t code) { return reason(what + ": " + dds_strretcode(code)); }

/// A topic entity of T in this participant. Each call creates an independent entity (they may have different filters).
template <class T>
Result<Entity> make_topic(const Entity& participant)
{
    const Topic& topic = topic_of<T>();
    const dds_entity_t e = dds_create_topic(participant.get(), topic.type, topic.name, qos_of(topic.delivery).get(), nullptr);
    if (e < 0) return failed(std::string("cannot create topic ") + topic.name, e);
    return Entity(e);
}

inline Result<Entity> make_publisher(const Entity& participant, const std::string& partition)
{
    const dds_entity_t e = dds_create_publisher(participant.get(), partition_qos(partition).get(), nullptr);
    if (e < 0) return failed("cannot create a publisher", e);
    return Entity(e);
}

inline Result<Entity> make_subscriber(const Entity& participant, const std::string& partition)
{
    const dds_entity_t e = dds_create_subscriber(participant.get(), partition_qos(partition).get(), nullptr);
    if (e < 0) return failed("cannot create a subscriber", e);
    return Entity(e);
}

/// Readers of a writer.
struct Matched
{
    std::uint32_t now = 0;
    std::uint32_t ever = 0;
};

template <class T>
class DataWriter
{
public:
    DataWriter() = default;
    static Result<DataWriter> make(const Entity& participant, const Entity& publisher)
    {
        auto topic = make_topic<T>(participant);
        if (!topic) return topic.errors();
        DataWriter w;
        w.topic_ = topic.take();
        const dds_entity_t e = dds_create_writer(publisher.get(), w.topic_.get(), qos_of(topic_of<T>().delivery).get(), nullptr);
        if (e < 0) return failed(std::string("cannot write ") + topic_of<T>().name, e);
        w.writer_ = Entity(e);
        return w;
    }
    /// DDS_RETCODE_OK or the error; reliable topics other than requests never block.
    dds_return_t write(const T& sample) { return dds_write(writer_.get(), &sample); }
    /// Reports that the instance with the key of `sample` no longer exists. Unregistering also disposes of it (autodispose, the
    /// default). Disposal alone would be kept forever, and sent to late joiners.
    dds_return_t dispose(const T& sample) { return dds_unregister_instance(writer_.get(), &sample); }
    Matched matched() const
    {
        dds_publication_matched_status_t status{};
        if (dds_get_publication_matched_status(writer_.get(), &status) < 0) return {};
        return {status.current_count, status.total_count};
    }
    /// Number of readers that are matched now.
    std::uint32_t readers() const { return matched().now; }
    const Entity& entity() const { return writer_; }

private:
    Entity topic_, writer_;  // order matters: the writer is destroyed first
};

template <class T>
class DataReader
{
public:
    DataReader() = default;
    /// `filter`: samples for which it returns false are not delivered to this reader.
    static Result<DataReader> make(const Entity& participant, const Entity& subscriber, dds_topic_filter_arg_fn filter = nullptr,
                                   void* argument = nullptr)
    {
        auto topic = make_topic<T>(participant);
        if (!topic) return topic.errors();
        DataReader r;
        r.topic_ = topic.take();
        if (filter != nullptr)
            if (const auto code = dds_set_topic_filter_and_arg(r.topic_.get(), filter, argument); code < 0)
                return failed(std::string("cannot filter ") + topic_of<T>().name, code);
        const dds_entity_t e = dds_create_reader(subscriber.get(), r.topic_.get(), qos_of(topic_of<T>().delivery).get(), nullptr);
        if (e < 0) return failed(std::string("cannot read ") + topic_of<T>().name, e);
        r.reader_ = Entity(e);
        return r;
    }
    /// Passes every waiting sample to `handle(const T&, const dds_sample_info_t&)`; valid_data false means that only the key is
    /// filled (the instance was disposed of, or its writer is gone). Returns their number, or an error code. Stops after the
    /// batch in which `most` is reached, so that a flood of samples cannot keep the reader's thread forever.
    template <class Handle>
    dds_return_t take(Handle&& handle, dds_return_t most = std::numeric_limits<dds_return_t>::max())
    {
        constexpr std::size_t kBatch = 64;
        dds_return_t total = 0;
        while (true)
        {
            std::array<void*, kBatch> samples{};
            std::array<dds_sample_info_t, kBatch> infos;
            const dds_return_t n = dds_take(reader_.get(), samples.data(), infos.data(), kBatch, kBatch);
            if (n <= 0) return n < 0 ? n : total;
            for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
                handle(*static_cast<const T*>(samples[i]), static_cast<const dds_sample_info_t&>(infos[i]));
            (void)dds_return_loan(reader_.get(), samples.data(), n);
            total += n;
            if (static_cast<std::size_t>(n) < kBatch || total >= most) return total;
        }
    }
    /// Number of writers that are matched now.
    std::uint32_t writers() const
    {
        dds_subscription_matched_status_t status{};
        return dds_get_subscription_matched_status(reader_.get(), &status) < 0 ? 0 : status.current_count;
    }
    const Entity& entity() const { return reader_; }

private:
    Entity topic_, reader_;
};

}  // namespace plab::wire
