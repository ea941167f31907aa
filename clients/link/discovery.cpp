#include "link/discovery.h"

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_typelib.h>

#include <algorithm>
#include <array>
#include <map>

#include "link/names.h"

namespace plab::link
{

struct TypeInfoDeleter
{
    void operator()(dds_typeinfo_t* info) const { (void)dds_free_typeinfo(info); }
};
namespace
{

using Clock = std::chrono::steady_clock;

struct DescriptorDeleter
{
    void operator()(dds_topic_descriptor_t* descriptor) const { (void)dds_delete_topic_descriptor(descriptor); }
};

using Guid = std::array<std::uint8_t, 16>;
Guid guid_of(const dds_guid_t& guid)
{
    Guid out;
    std::copy(std::begin(guid.v), std::end(guid.v), out.begin());
    return out;
}

std::set<std::string> partitions_of(const dds_qos_t* qos)
{
    std::uint32_t n = 0;
    char** names = nullptr;
    std::set<std::string> out;
    if (dds_qget_partition(qos, &n, &names))
        for (std::uint32_t i = 0; i < n; ++i) out.insert(names[i]), dds_free(names[i]);
    dds_free(names);
    if (out.empty()) out.insert("");
    return out;
}

std::string qos_text(const dds_qos_t* qos)
{
    dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
    dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
    dds_history_kind_t history = DDS_HISTORY_KEEP_LAST;
    dds_duration_t duration = 0;
    std::int32_t depth = 0;
    (void)dds_qget_reliability(qos, &reliability, &duration);
    (void)dds_qget_durability(qos, &durability);
    std::string text = reliability == DDS_RELIABILITY_RELIABLE ? "reliable" : "best effort";
    constexpr std::array kDurable{"", ", transient local", ", transient", ", persistent"};
    text += kDurable.at(static_cast<std::size_t>(durability) % kDurable.size());
    if (dds_qget_history(qos, &history, &depth))
        text += history == DDS_HISTORY_KEEP_ALL ? ", keep all" : ", keep last " + std::to_string(depth);
    return text;
}

/// Cyclone DDS 0.10 treats the keys of types built at run time as short and of fixed length, even strings: one of more than 11
/// characters then overruns its place in the sample. Without those flags it reserves enough space for a key.
dds_topic_descriptor_t with_keys_of_any_length(const dds_topic_descriptor_t& d)
{
    constexpr std::uint32_t kFixed = DDS_TOPIC_FIXED_KEY | DDS_TOPIC_FIXED_KEY_XCDR2;
    return {
        d.m_size,           d.m_align,      d.m_flagset & ~kFixed,         d.m_nkeys, d.m_typename, d.m_keys, d.m_nops, d.m_ops, d.m_meta,
        d.type_information, d.type_mapping, d.restrict_data_representation};
}

Origin origin_of(const std::string& topic, const std::string& type)
{
    for (const wire::Topic& t : wire::topics())
        if (topic == t.name) return type == t.type->m_typename ? Origin::Plab : Origin::OtherVersion;
    return Origin::Foreign;
}

}  // namespace

struct Discovery::Endpoint
{
    std::string topic, type;
    bool is_writer = false;
    std::set<std::string> partitions;
    wire::Qos qos;
    std::unique_ptr<dds_typeinfo_t, TypeInfoDeleter> info;  ///< null: it sends none
};

struct Discovery::Known
{
    Guid self{};  ///< the participant, whose own readers are not shown
    std::map<Guid, Discovery::Endpoint> endpoints;
    std::uint64_t changes = 0;

    void take(dds_entity_t reader, bool is_writer);
    void add(const dds_builtintopic_endpoint_t& from, bool is_writer);
};

void Discovery::KnownDeleter::operator()(Known* known) const { delete known; }

void Discovery::Known::take(dds_entity_t reader, bool is_writer)
{
    constexpr std::size_t kBatch = 32;
    dds_return_t n = 0;
    do {
        std::array<void*, kBatch> samples{};
        std::array<dds_sample_info_t, kBatch> infos;
        n = dds_take(reader, samples.data(), infos.data(), kBatch, kBatch);
        for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(n, 0)); ++i)
        {
            const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
            ++changes;
            if (infos[i].instance_state != DDS_IST_ALIVE)
                endpoints.erase(guid_of(endpoint.key));
            else if (infos[i].valid_data && guid_of(endpoint.participant_key) != self)
                add(endpoint, is_writer);
        }
        if (n > 0) (void)dds_return_loan(reader, samples.data(), n);
    } while (n == static_cast<dds_return_t>(kBatch));
}

void Discovery::Known::add(const dds_builtintopic_endpoint_t& from, bool is_writer)
{
    Endpoint endpoint{from.topic_name, from.type_name, is_writer, partitions_of(from.qos), wire::Qos(dds_create_qos()), nullptr};
    (void)dds_copy_qos(endpoint.qos.get(), from.qos);
    const dds_typeinfo_t* info = nullptr;
    // The information dies with the sample: keep a copy.
    if (is_writer && dds_builtintopic_get_endpoint_type_info(const_cast<dds_builtintopic_endpoint_t*>(&from), &info) == DDS_RETCODE_OK &&
        info != nullptr)
        endpoint.info.reset(ddsi_typeinfo_dup(info));
    endpoints[guid_of(from.key)] = std::move(endpoint);
}

Result<Discovery> Discovery::make(const wire::Entity& participant)
{
    Discovery out;
    out.participant_ = participant.get();
    out.known_.reset(new Known);
    dds_guid_t self{};
    if (const auto code = dds_get_guid(participant.get(), &self); code < 0) return wire::failed("cannot inspect the bus", code);
    out.known_->self = guid_of(self);
    out.waitset_ = wire::Entity(dds_create_waitset(participant.get()));
    const auto listen = [&](dds_entity_t topic, wire::Entity& reader) -> dds_return_t
    {
        const dds_entity_t e = dds_create_reader(participant.get(), topic, nullptr, nullptr);
        if (e < 0) return e;
        reader = wire::Entity(e);
        (void)dds_set_status_mask(e, DDS_DATA_AVAILABLE_STATUS);
        return dds_waitset_attach(out.waitset_.get(), e, 0);
    };
    if (const auto code = listen(DDS_BUILTIN_TOPIC_DCPSPUBLICATION, out.writers_); code < 0)
        return wire::failed("cannot inspect the writers on the bus", code);
    if (const auto code = listen(DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, out.readers_); code < 0)
        return wire::failed("cannot inspect the readers on the bus", code);
    return out;
}

void Discovery::update()
{
    known_->take(writers_.get(), true);
    known_->take(readers_.get(), false);
}

std::vector<TopicInfo> Discovery::topics(Seconds quiet, Seconds longest, const Stop& stop)
{
    // Under load, the first answer may take longer than the later ones.
    constexpr Seconds kFirst(1);
    const auto begin = Clock::now();
    update();
    auto settled = moment_after(known_->endpoints.empty() ? std::max(kFirst, quiet) : quiet, begin);
    while (Clock::now() < std::min(settled, moment_after(longest, begin)) && !(stop && stop()))
    {
        const std::uint64_t changes = known_->changes;
        (void)dds_waitset_wait(waitset_.get(), nullptr, 0, DDS_MSECS(50));
        update();
        if (known_->changes != changes && !known_->endpoints.empty()) settled = moment_after(quiet);
    }
    std::map<std::pair<std::string, std::string>, TopicInfo> found;
    const auto has_writer = [&](const Endpoint& e)
    {
        return std::any_of(known_->endpoints.begin(), known_->endpoints.end(),
                           [&](const auto& other)
                           { return other.second.is_writer && other.second.topic == e.topic && other.second.type == e.type; });
    };
    for (const auto& [guid, endpoint] : known_->endpoints)
    {
        TopicInfo& info = found[{endpoint.topic, endpoint.type}];
        info.name = endpoint.topic, info.type = endpoint.type;
        info.origin = origin_of(endpoint.topic, endpoint.type);
        ++(endpoint.is_writer ? info.writers : info.readers);
        if (!endpoint.is_writer && has_writer(endpoint)) continue;
        info.qos.insert(qos_text(endpoint.qos.get()));
        info.partitions.insert(endpoint.partitions.begin(), endpoint.partitions.end());
    }
    std::vector<TopicInfo> out;
    for (auto& [name, info] : found) out.push_back(std::move(info));
    return out;
}

std::vector<const Discovery::Endpoint*> Discovery::writers_of(const std::string& topic, const RawOptions& options) const
{
    std::vector<const Endpoint*> out;
    for (const auto& [guid, endpoint] : known_->endpoints)
        if (endpoint.is_writer && endpoint.topic == topic && (options.partition.empty() || endpoint.partitions.contains(options.partition)))
            out.push_back(&endpoint);
    return out;
}

bool Discovery::wait_for_writer(const std::string& topic, const RawOptions& options, Seconds timeout, const Stop& stop)
{
    const auto end = moment_after(timeout);
    update();
    while (writers_of(topic, options).empty() && Clock::now() < end && !(stop && stop()))
    {
        (void)dds_waitset_wait(waitset_.get(), nullptr, 0, DDS_MSECS(50));
        update();
    }
    if (writers_of(topic, options).empty()) return false;
    // One more pass: the other writers of a newly found program appear within milliseconds.
    (void)topics(Seconds(0.05), Seconds(0.3), stop);
    return true;
}

namespace
{

/// The strictest QoS that a reader may request so that all of these writers match it.
struct Offer
{
    bool is_reliable = true, is_kept = true, is_exclusive = false;
    std::set<std::string> partitions;

    void narrow(const dds_qos_t* qos)
    {
        dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
        dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
        dds_ownership_kind_t ownership = DDS_OWNERSHIP_SHARED;
        dds_duration_t blocking = 0;
        (void)dds_qget_reliability(qos, &reliability, &blocking);
        (void)dds_qget_durability(qos, &durability);
        (void)dds_qget_ownership(qos, &ownership);
        is_reliable = is_reliable && reliability == DDS_RELIABILITY_RELIABLE;
        is_kept = is_kept && durability != DDS_DURABILITY_VOLATILE;
        is_exclusive = is_exclusive || ownership == DDS_OWNERSHIP_EXCLUSIVE;
        partitions.merge(partitions_of(qos));
    }
    wire::Qos reader_qos(bool wants_history) const
    {
        wire::Qos qos(dds_create_qos());
        dds_qset_reliability(qos.get(), is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_SECS(1));
        dds_qset_durability(qos.get(), is_kept && wants_history ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
        dds_qset_ownership(qos.get(), is_exclusive ? DDS_OWNERSHIP_EXCLUSIVE : DDS_OWNERSHIP_SHARED);
        dds_qset_latency_budget(qos.get(), DDS_INFINITY);
        // This reader may be slow: it must neither block the writer nor use unbounded memory.
        dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1024);
        return qos;
    }
    wire::Qos subscriber_qos(const std::string& only) const
    {
        std::vector<const char*> names;
        for (const std::string& name : partitions)
            if (only.empty() || name == only) names.push_back(name.c_str());
        wire::Qos qos(dds_create_qos());
        dds_qset_partition(qos.get(), static_cast<std::uint32_t>(names.size()), names.data());
        return qos;
    }
};

}  // namespace

Result<RawReader> Discovery::read(const std::vector<const Endpoint*>& writers, const Endpoint& described, const RawOptions& options) const
{
    const std::string& name = described.topic;
    dds_topic_descriptor_t* made = nullptr;
    auto code = dds_create_topic_descriptor(DDS_FIND_SCOPE_GLOBAL, participant_, described.info.get(), DDS_SECS(2), &made);
    if (code == DDS_RETCODE_UNSUPPORTED)
        return reason(
            described.type +
            " cannot be built by this version of Cyclone DDS from its description, perhaps because of a bounded string in its key");
    if (code < 0) return wire::failed("cannot fetch the type of '" + name + "' from its writer", code);
    const std::unique_ptr<dds_topic_descriptor_t, DescriptorDeleter> descriptor(made);
    RawReader out;
    out.type_name_ = described.type;
    if (auto type = describe_type(participant_, described.info.get()); type)
        out.type_ = type.take();
    else
        out.why_opaque_ = type.error().text();
    Offer offer;
    for (const Endpoint* writer : writers) offer.narrow(writer->qos.get());
    const dds_topic_descriptor_t safe = with_keys_of_any_length(*descriptor);
    if (code = dds_create_topic(participant_, &safe, name.c_str(), nullptr, nullptr); code < 0)
        return wire::failed("cannot use the topic '" + name + "'", code);
    out.topic_ = wire::Entity(code);
    if (code = dds_create_subscriber(participant_, offer.subscriber_qos(options.partition).get(), nullptr); code < 0)
        return wire::failed("cannot create a subscriber", code);
    out.subscriber_ = wire::Entity(code);
    if (code = dds_create_reader(code, out.topic_.get(), offer.reader_qos(options.wants_history).get(), nullptr); code < 0)
        return wire::failed("cannot read '" + name + "'", code);
    out.reader_ = wire::Entity(code);
    if (auto waits = out.make_waitset(participant_); !waits) return waits.errors();
    return out;
}

Result<RawReader> Discovery::open(const std::string& topic, const RawOptions& options)
{
    update();
    const auto writers = writers_of(topic, options);
    std::vector<std::string> names;
    std::set<std::string> types;
    for (const auto& [guid, endpoint] : known_->endpoints)
        if (endpoint.is_writer) names.push_back(endpoint.topic);
    for (const Endpoint* writer : writers) types.insert(writer->type);
    if (writers.empty())
    {
        const std::string where = options.partition.empty() ? "" : " in partition '" + options.partition + "'";
        return reason("there is no writer of '" + topic + "'" + where + did_you_mean(topic, names));
    }
    if (types.size() > 1)
        return reason("'" + topic + "' is written with several types, " + *types.begin() + " and " + *types.rbegin() +
                      " among them: name a partition with only one type");
    const auto described = std::find_if(writers.begin(), writers.end(), [](const Endpoint* e) { return e->info != nullptr; });
    if (described == writers.end())
        return reason("the writers of '" + topic + "' do not describe its type: it cannot be read without its IDL");
    return read(writers, **described, options);
}

}  // namespace plab::link
