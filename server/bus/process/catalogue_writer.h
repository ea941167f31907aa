/// What the scene consists of, as keyed topics that late joiners receive too. Bus thread only.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "bus/process/trouble.h"
#include "idl/entity.h"
#include "wire/samples.h"

namespace plab::bus
{

/// One keyed topic: one instance per component. Key: the member of T that names it.
template <class T, char* T::*Key, class Sample>
class KeyedTopic
{
public:
    Result<void> open(const wire::Entity& participant, const wire::Entity& publisher);
    template <class Record>
    void put(const std::string& id, const std::string& type, const Record& record, Trouble& trouble);
    void dispose(const std::string& id, Trouble& trouble);
    /// Disposes of every instance that is not in `records`; id_of returns a record's id.
    template <class Record, class IdOf>
    void dispose_all_but(const std::vector<Record>& records, IdOf&& id_of, Trouble& trouble);
    bool has_type_below(std::string_view prefix) const;
    const wire::Entity& writer() const { return writer_.entity(); }

private:
    void dispose_key(const std::string& id, Trouble& trouble);

    wire::Writer<T> writer_;
    Sample sample_;
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
    wire::Writer<plab_v2_Scene> scene_;
    wire::SceneSample scene_sample_;
    KeyedTopic<plab_v2_SceneObject, &plab_v2_SceneObject::component_id, wire::ObjectSample> objects_;
    KeyedTopic<plab_v2_Shape, &plab_v2_Shape::component_id, wire::ShapeSample> shapes_;
    KeyedTopic<plab_v2_Interaction, &plab_v2_Interaction::component_id, wire::InteractionSample> interactions_;
    KeyedTopic<plab_v2_Type, &plab_v2_Type::type_name, wire::TypeSample> types_;
};

}  // namespace plab::bus
