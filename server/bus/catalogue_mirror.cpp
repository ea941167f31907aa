#include "bus/catalogue_mirror.h"

#include <algorithm>

namespace plab::bus
{

void CatalogueMirror::apply(const publish::CatalogueChange& change)
{
    is_there_ = true;
    if (change.everything) objects_.clear(), shapes_.clear(), interactions_.clear();
    const auto erase = [this](const std::string& id) { objects_.erase(id), shapes_.erase(id), interactions_.erase(id); };
    for (const std::string& id : change.gone) erase(id);
    // An id belongs to one component: if it comes back as another kind, remove the entry of the former kind.
    const auto put = [&](auto& known, const auto& entries)
    {
        for (const auto& entry : entries) erase(entry.component_id), known.insert_or_assign(entry.component_id, entry);
    };
    put(shapes_, change.shapes), put(objects_, change.objects), put(interactions_, change.interactions);
    if (change.everything && !change.types.empty())
        types_ = change.types;
    else
        for (const wire::Type& type : change.types)
        {
            const auto known = std::find_if(types_.begin(), types_.end(), [&](const auto& t) { return t.type_name == type.type_name; });
            known == types_.end() ? types_.push_back(type) : void(*known = type);
        }
    scene_ = change.scene;
}

publish::CatalogueChange CatalogueMirror::everything() const
{
    publish::CatalogueChange out;
    out.everything = true, out.scene = scene_, out.types = types_;
    for (const auto& [id, object] : objects_) out.objects.push_back(object);
    for (const auto& [id, shape] : shapes_) out.shapes.push_back(shape);
    for (const auto& [id, interaction] : interactions_) out.interactions.push_back(interaction);
    return out;
}

}  // namespace plab::bus
