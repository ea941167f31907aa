/// What the scene consists of, kept for a plab-bus that is started again: nobody has to ask the step thread.
#pragma once

#include <map>
#include <string>

#include "publish/records.h"

namespace plab::bus
{

class CatalogueMirror
{
public:
    void apply(const publish::CatalogueChange& change);
    bool empty() const { return !is_there_; }
    /// All of it.
    publish::CatalogueChange everything() const;

private:
    template <class Entry>
    using Shelf = std::map<std::string, Entry>;

    bool is_there_ = false;
    publish::SceneEntry scene_;
    Shelf<publish::ObjectEntry> objects_;
    Shelf<publish::ShapeEntry> shapes_;
    Shelf<publish::InteractionEntry> interactions_;
    std::vector<model::TypeSummary> types_;
};

}  // namespace plab::bus
