#include "bus/process/catalogue_writer.h"

#include <algorithm>
#include <set>

#include "wire/wire_view.h"

namespace plab::bus
{

template <class T, char* T::*Key, class Sample>
Result<void> KeyedTopic<T, Key, Sample>::open(const wire::Entity& participant, const wire::Entity& publisher)
{
    auto writer = wire::Writer<T>::make(participant, publisher);
    if (!writer) return writer.errors();
    writer_ = writer.take();
    return {};
}

template <class T, char* T::*Key, class Sample>
template <class Record>
void KeyedTopic<T, Key, Sample>::put(const std::string& id, const std::string& type, const Record& record, Trouble& trouble)
{
    type_of_[id] = type;
    (void)trouble.check(wire::topic_of<T>().name, writer_.write(sample_.of(record)));
}

template <class T, char* T::*Key, class Sample>
void KeyedTopic<T, Key, Sample>::dispose(const std::string& id, Trouble& trouble)
{
    if (type_of_.erase(id) > 0) dispose_key(id, trouble);
}

template <class T, char* T::*Key, class Sample>
template <class Record, class IdOf>
void KeyedTopic<T, Key, Sample>::dispose_all_but(const std::vector<Record>& records, IdOf&& id_of, Trouble& trouble)
{
    std::set<std::string_view> stay;
    for (const Record& record : records) stay.insert(id_of(record));
    for (auto entry = type_of_.begin(); entry != type_of_.end();)
    {
        if (stay.contains(entry->first))
        {
            ++entry;
            continue;
        }
        dispose_key(entry->first, trouble);
        entry = type_of_.erase(entry);
    }
}

template <class T, char* T::*Key, class Sample>
bool KeyedTopic<T, Key, Sample>::has_type_below(std::string_view prefix) const
{
    return std::any_of(type_of_.begin(), type_of_.end(), [&](const auto& entry) { return entry.second.starts_with(prefix); });
}

template <class T, char* T::*Key, class Sample>
void KeyedTopic<T, Key, Sample>::dispose_key(const std::string& id, Trouble& trouble)
{
    T key{};
    key.*Key = wire::text(id);
    (void)trouble.check(wire::topic_of<T>().name, writer_.dispose(key));
}

Result<void> CatalogueWriter::open(const wire::Entity& participant, const wire::Entity& publisher)
{
    auto scene = wire::Writer<plab_v2_Scene>::make(participant, publisher);
    if (!scene) return scene.errors();
    scene_ = scene.take();
    if (auto opened = objects_.open(participant, publisher); !opened) return opened;
    if (auto opened = shapes_.open(participant, publisher); !opened) return opened;
    if (auto opened = interactions_.open(participant, publisher); !opened) return opened;
    return types_.open(participant, publisher);
}

void CatalogueWriter::apply(const publish::CatalogueChange& change, Trouble& trouble)
{
    dispose_what_is_gone(change, trouble);
    // An id belongs to one component: if it comes back as another kind, its entry in the former topic is disposed.
    for (const publish::ShapeEntry& shape : change.shapes)
    {
        objects_.dispose(shape.component, trouble), interactions_.dispose(shape.component, trouble);
        shapes_.put(shape.component, shape.type, shape, trouble);
    }
    for (const publish::ObjectEntry& object : change.objects)
    {
        shapes_.dispose(object.component, trouble), interactions_.dispose(object.component, trouble);
        objects_.put(object.component, object.type, object, trouble);
    }
    for (const publish::InteractionEntry& interaction : change.interactions)
    {
        shapes_.dispose(interaction.component, trouble), objects_.dispose(interaction.component, trouble);
        interactions_.put(interaction.component, interaction.type, interaction, trouble);
    }
    for (const model::TypeSummary& type : change.types) types_.put(type.name, type.name, type, trouble);
    // Last, so that a client that waits for a new run finds the run's parts there.
    (void)trouble.check(wire::topic_of<plab_v2_Scene>().name, scene_.write(scene_sample_.of(server_, change.scene)));
}

void CatalogueWriter::dispose_what_is_gone(const publish::CatalogueChange& change, Trouble& trouble)
{
    if (change.everything)
    {
        const auto component = [](const auto& record) -> std::string_view { return record.component; };
        objects_.dispose_all_but(change.objects, component, trouble);
        shapes_.dispose_all_but(change.shapes, component, trouble);
        interactions_.dispose_all_but(change.interactions, component, trouble);
        if (!change.types.empty())
            types_.dispose_all_but(
                change.types, [](const model::TypeSummary& type) -> std::string_view { return type.name; }, trouble);
    }
    for (const std::string& id : change.gone)
        objects_.dispose(id, trouble), shapes_.dispose(id, trouble), interactions_.dispose(id, trouble);
}

void CatalogueWriter::dispose_all(Trouble& trouble)
{
    publish::CatalogueChange nothing;
    nothing.everything = true;
    dispose_what_is_gone(nothing, trouble);
    types_.dispose_all_but(
        std::vector<std::string>{}, [](const std::string& s) -> std::string_view { return s; }, trouble);
    plab_v2_Scene key{};
    key.server_name = wire::text(server_);
    (void)trouble.check(wire::topic_of<plab_v2_Scene>().name, scene_.dispose(key));
}

bool CatalogueWriter::has_type_below(std::string_view prefix) const { return interactions_.has_type_below(prefix); }

std::array<dds_entity_t, 5> CatalogueWriter::writers() const
{
    return {scene_.entity().get(), objects_.writer().get(), shapes_.writer().get(), interactions_.writer().get(), types_.writer().get()};
}

}  // namespace plab::bus
