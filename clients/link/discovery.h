/// All topics on the bus, pLab's or not, with their writers, readers and types, and samples of any of them.
/// A type that is not compiled in is fetched from the program that writes it (XTypes type discovery).
#pragma once

#include <functional>
#include <set>

#include "link/dynamic_sample.h"
#include "link/session.h"

namespace plab::link
{

enum class Origin : std::uint8_t
{
    Foreign,
    Plab,
    OtherVersion,  ///< a pLab topic name with a type of another version
};

/// All writers and readers of one topic that agree on the type's name.
struct TopicInfo
{
    std::string name, type;
    std::set<std::string> partitions;  ///< "": the default one
    std::size_t writers = 0, readers = 0;
    std::set<std::string> qos;  ///< QoS of its writers, or of its readers if it has no writers
    Origin origin = Origin::Foreign;
};

/// One sample in wire format.
struct RawSample
{
    std::span<const std::byte> bytes;  ///< starts with the encoding; a sample that only reports that an instance is gone has the key
    bool has_value = true;
    bool is_gone = false;  ///< the instance was disposed of, or has no writer any more
    std::int64_t written_ns = 0;
    std::uint64_t writer = 0;
    std::uint64_t instance = 0;  ///< the same number for the same key; only to be compared
};

/// Reads one topic without knowing its type at compile time.
class RawReader
{
public:
    /// One of our own topics, of the session's server. Blocks no writer: requests are read without being acknowledged, and a
    /// slow reader misses samples. `depth`: number of samples that may wait here, per instance.
    static Result<RawReader> open(const Session& session, const wire::Topic& topic, std::int32_t depth);

    /// Its type; null if it cannot be shown, and then why_opaque() returns the reason.
    const DynamicTypePtr& type() const { return type_; }
    const std::string& why_opaque() const { return why_opaque_; }
    const std::string& type_name() const { return type_name_; }

    bool wait(Seconds timeout) const;
    /// Passes on the waiting samples, at most one batch; returns their number.
    std::size_t take(const std::function<void(const RawSample&)>& handle);
    std::uint32_t writers() const;
    const wire::Entity& entity() const { return reader_; }

private:
    friend class Discovery;
    Result<void> make_waitset(dds_entity_t participant);

    std::string type_name_, why_opaque_;
    DynamicTypePtr type_;
    wire::Entity topic_, subscriber_, reader_, waitset_;
};

struct RawOptions
{
    std::string partition;      ///< "": all partitions in which the topic has writers
    bool wants_history = true;  ///< also what writers keep for late joiners
};

/// Not thread-safe; must not outlive the participant.
class Discovery
{
public:
    static Result<Discovery> make(const wire::Entity& participant);

    /// All endpoints that appear, until nothing new has appeared for `quiet`, at most for `longest`. On an empty bus that is
    /// one second.
    std::vector<TopicInfo> topics(Seconds quiet, Seconds longest, const Stop& stop = {});
    /// False: it has no writer (in that partition) until `timeout`.
    bool wait_for_writer(const std::string& topic, const RawOptions& options, Seconds timeout, const Stop& stop = {});
    /// Reads from the currently known writers, and from later ones with the same type.
    Result<RawReader> open(const std::string& topic, const RawOptions& options);

private:
    struct Endpoint;
    struct Known;
    struct KnownDeleter
    {
        void operator()(Known* known) const;
    };

    void update();
    std::vector<const Endpoint*> writers_of(const std::string& topic, const RawOptions& options) const;
    Result<RawReader> read(const std::vector<const Endpoint*>& writers, const Endpoint& described, const RawOptions& options) const;

    dds_entity_t participant_ = 0;
    wire::Entity writers_, readers_, waitset_;
    std::unique_ptr<Known, KnownDeleter> known_;
};

/// The structure of a type, from the type objects that `participant` knows. An error names the member whose kind is not
/// supported.
Result<DynamicTypePtr> describe_type(dds_entity_t participant, const dds_typeinfo_t* type);

}  // namespace plab::link
