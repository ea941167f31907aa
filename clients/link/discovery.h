/// What is on the bus, pLab's or not: topics with their writers, readers and types, and samples of any of them.
///
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
    OtherVersion,  ///< a name of pLab's with a type that is not of this version
};

/// All writers and readers of one topic that agree on the type's name.
struct TopicInfo
{
    std::string name, type;
    std::set<std::string> partitions;  ///< "": the default one
    std::size_t writers = 0, readers = 0;
    std::set<std::string> qos;  ///< of its writers; of its readers if it has no writers
    Origin origin = Origin::Foreign;
};

/// One sample as it was on the wire.
struct RawSample
{
    std::span<const std::byte> bytes;  ///< encoding first; a sample that only says that an instance is gone has the key
    bool has_value = true;
    bool is_gone = false;  ///< the instance was disposed of, or nobody writes it any more
    std::int64_t written_ns = 0;
    std::uint64_t writer = 0;
};

/// Reads one topic without knowing its type.
class RawReader
{
public:
    /// One of our own topics, of the session's server. Holds nobody up: requests are read without being acknowledged, and
    /// who takes too late misses samples. `depth`: how many wait here, of each instance.
    static Result<RawReader> open(const Session& session, const wire::Topic& topic, std::int32_t depth);

    /// What it is made of; null if that cannot be shown, and why_opaque() says why.
    const DynamicTypePtr& type() const { return type_; }
    const std::string& why_opaque() const { return why_opaque_; }
    const std::string& type_name() const { return type_name_; }

    bool wait(Seconds timeout) const;
    /// Hands over what waits, a batch of it at the most; how many there were.
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
    std::string partition;      ///< "": all that the topic has writers in
    bool wants_history = true;  ///< what writers keep for late joiners
};

/// Not thread-safe; must not outlive the participant.
class Discovery
{
public:
    static Result<Discovery> make(const wire::Entity& participant);

    /// What shows itself until nothing new came for `quiet`, at the most for `longest`. On an empty bus that is a second.
    std::vector<TopicInfo> topics(Seconds quiet, Seconds longest, const Stop& stop = {});
    /// False: nobody writes it (in that partition) until `timeout`.
    bool wait_for_writer(const std::string& topic, const RawOptions& options, Seconds timeout, const Stop& stop = {});
    /// Reads what its writers that are known now write, and those that come later with the same type.
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

/// What a type is made of, from the type objects that `participant` knows. An error names the member that is of a kind
/// that is not understood.
Result<DynamicTypePtr> describe_type(dds_entity_t participant, const dds_typeinfo_t* type);

}  // namespace plab::link
