#include "bus/process/catalogue_writer.h"

#include <algorithm>
#include <set>

namespace plab::bus
{

template <class T, char* T::*Key, class Value, std::string Value::*KeyOf>
Result<void> KeyedTopic<T, Key, Value, KeyOf>::open(const wire::Entity& participant, const wire::Entity& publisher)
{
    auto writer = wire::DataWriter<T>::make(participant, publisher);
    if (!writer) return writer.errors();
    writer_ = writer.take();
    return {};
}

template <class T, char* T::*Key, class Value, std::string Value::*KeyOf>
void KeyedTopic<T, Key, Value, KeyOf>::put(const Value& value, Trouble& trouble)
{
    type_of_[value.*KeyOf] = value.type_name;
    (void)trouble.check(wire::topic_of<T>().name, writer_.write(sample_.of(value)));
}

template <class T, char* T::*Key, class Value, std::string Value::*KeyOf>
void KeyedTopic<T, Key, Value, KeyOf>::dispose(const std::string& id, Trouble& trouble)
{
    if (type_of_.erase(id) > 0) dispose_key(id, trouble);
}

template <class T, char* T::*Key, class Value, std::string Value::*KeyOf>
void KeyedTopic<T, Key, Value, KeyOf>::dispose_all_but(const std::vector<Value>& values, Trouble& trouble)
{
    std::set<std::string_view> stay;
    for (const Value& value : values) stay.insert(value.*KeyOf);
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

template <class T, char* T::*Key, class Value, std::string Value::*KeyOf>
bool KeyedTopic<T, Key, Value, KeyOf>::has_type_below(std::string_view prefix) const
{
    return std::any_of(type_of_.begin(), type_of_.end(), [&](const auto& entry) { return entry.second.starts_with(prefix); });
}

template <class T, char* T::*Key, class Value, std::string Value::*KeyOf>
void KeyedTopic<T, Key, Value, KeyOf>::dispose_key(const std::string& id, Trouble& trouble)
{
    T key{};
    key.*Key = wire::text(id);
    (void)trouble.check(wire::topic_of<T>().name, writer_.dispose(key));
}

Result<void> CatalogueWriter::open(const wire::Entity& participant, const wire::Entity& publisher)
{
    auto scene = wire::DataWriter<plab_v2_Scene>::make(participant, publisher);
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
    for (const wire::Shape& shape : change.shapes)
    {
        objects_.dispose(shape.component_id, trouble), interactions_.dispose(shape.component_id, trouble);
        shapes_.put(shape, trouble);
    }
    for (const wire::SceneObject& object : change.objects)
    {
        shapes_.dispose(object.component_id, trouble), interactions_.dispose(object.component_id, trouble);
        objects_.put(object, trouble);
    }
    for (const wire::Interaction& interaction : change.interactions)
    {
        shapes_.dispose(interaction.component_id, trouble), objects_.dispose(interaction.component_id, trouble);
        interactions_.put(interaction, trouble);
    }
    for (const wire::Type& type : change.types) types_.put(type, trouble);
    // Last, so that a client that waits for a new run finds the run's parts there.
    plab_v2_Scene scene = scene_sample_.of(change.scene);
    scene.server_name = wire::text(server_);
    (void)trouble.check(wire::topic_of<plab_v2_Scene>().name, scene_.write(scene));
}

void CatalogueWriter::dispose_what_is_gone(const publish::CatalogueChange& change, Trouble& trouble)
{
    if (change.everything)
    {
        objects_.dispose_all_but(change.objects, trouble);
        shapes_.dispose_all_but(change.shapes, trouble);
        interactions_.dispose_all_but(change.interactions, trouble);
        if (!change.types.empty()) types_.dispose_all_but(change.types, trouble);
    }
    for (const std::string& id : change.gone)
        objects_.dispose(id, trouble), shapes_.dispose(id, trouble), interactions_.dispose(id, trouble);
}

void CatalogueWriter::dispose_all(Trouble& trouble)
{
    publish::CatalogueChange nothing;
    nothing.everything = true;
    dispose_what_is_gone(nothing, trouble);
    types_.dispose_all_but({}, trouble);
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
