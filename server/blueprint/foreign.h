/// Foreign XML inside a component, such as XGL's <MESH>, is handed to the handler that is registered for that element.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "blueprint/xml.h"
#include "model/blueprint.h"

namespace plab::blueprint
{

/// Converts a foreign element to values of the component that contains it. Places in errors and values need no file name: the
/// reader adds it.
struct ForeignHandler
{
    std::string element;
    std::string implied_type;  ///< type of a component that states none
    std::function<Result<std::vector<model::ValueNode>>(const XmlElement&)> read;
};

class ForeignHandlers
{
public:
    /// A later handler of the same element replaces an earlier one.
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
