/// What the scene consists of, kept so that a restarted plab-bus can get it without asking the step thread.
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
    /// The whole catalogue.
    publish::CatalogueChange everything() const;

private:
    template <class Entry>
    using EntriesById = std::map<std::string, Entry>;

    bool is_there_ = false;
    wire::Scene scene_;
    EntriesById<wire::SceneObject> objects_;
    EntriesById<wire::Shape> shapes_;
    EntriesById<wire::Interaction> interactions_;
    std::vector<wire::Type> types_;
};

}  // namespace plab::bus
