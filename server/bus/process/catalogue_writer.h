/// What the scene consists of, as keyed topics that late joiners receive too. Bus thread only.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "bus/process/trouble.h"
#include "idl/entity.h"
#include "idl/samples.h"
#include "publish/records.h"

namespace plab::bus
{

/// One keyed topic: one instance per component. Key: the member of T that names it; KeyOf: the same of its value.
template <class T, char* T::*Key, class Value, std::string Value::*KeyOf>
class KeyedTopic
{
public:
    Result<void> open(const wire::Entity& participant, const wire::Entity& publisher);
    void put(const Value& value, Trouble& trouble);
    void dispose(const std::string& id, Trouble& trouble);
    /// Disposes of every instance that is not in `values`.
    void dispose_all_but(const std::vector<Value>& values, Trouble& trouble);
    bool has_type_below(std::string_view prefix) const;
    const wire::Entity& writer() const { return writer_.entity(); }

private:
    void dispose_key(const std::string& id, Trouble& trouble);

    wire::DataWriter<T> writer_;
    wire::SampleView<T> sample_;
    std::map<std::string, std::string> type_of_;  // id -> type, of the existing interactions
};

class CatalogueWriter
{
public:
    explicit CatalogueWriter(std::string server) : server_(std::move(server)) {}

    Result<void> open(const wire::Entity& participant, const wire::Entity& publisher);
    void apply(const publish::CatalogueChange& change, Trouble& trouble);
    void dispose_all(Trouble& trouble);
    /// Whether an interaction has a type like "Camera/...".
    bool has_type_below(std::string_view prefix) const;
    std::array<dds_entity_t, 5> writers() const;

private:
    void dispose_what_is_gone(const publish::CatalogueChange& change, Trouble& trouble);

    std::string server_;
    wire::DataWriter<plab_v2_Scene> scene_;
    wire::SampleView<plab_v2_Scene> scene_sample_;
    KeyedTopic<plab_v2_SceneObject, &plab_v2_SceneObject::component_id, wire::SceneObject, &wire::SceneObject::component_id> objects_;
    KeyedTopic<plab_v2_Shape, &plab_v2_Shape::component_id, wire::Shape, &wire::Shape::component_id> shapes_;
    KeyedTopic<plab_v2_Interaction, &plab_v2_Interaction::component_id, wire::Interaction, &wire::Interaction::component_id> interactions_;
    KeyedTopic<plab_v2_Type, &plab_v2_Type::type_name, wire::Type, &wire::Type::type_name> types_;
};

}  // namespace plab::bus
