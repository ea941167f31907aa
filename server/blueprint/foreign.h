/// Foreign XML inside a component, such as XGL's <MESH>, is handed to whoever registered for that element.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "blueprint/xml.h"
#include "model/blueprint.h"

namespace plab::blueprint
{

/// Turns a foreign element into values of the component that holds it. Places in errors and values need no file: the
/// reader adds it.
struct ForeignHandler
{
    std::string element;
    std::string implied_type;  ///< of a component that states no type
    std::function<Result<std::vector<model::ValueNode>>(const XmlElement&)> read;
};

class ForeignHandlers
{
public:
    /// A later handler of the same element takes its place.
    void add(ForeignHandler handler)
    {
        for (ForeignHandler& h : handlers_)
            if (h.element == handler.element) return void(h = std::move(handler));
        handlers_.push_back(std::move(handler));
    }
    const ForeignHandler* find(std::string_view element) const
    {
        for (const ForeignHandler& h : handlers_)
            if (h.element == element) return &h;
        return nullptr;
    }
    const std::vector<ForeignHandler>& all() const { return handlers_; }

private:
    std::vector<ForeignHandler> handlers_;
};

}  // namespace plab::blueprint
