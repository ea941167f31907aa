#include "program/command_outline.h"

#include <algorithm>

namespace plab::program
{

const CommandOutline* CommandOutline::find(const std::string& command) const
{
    const auto at = std::find_if(commands.begin(), commands.end(), [&](const CommandOutline& c) { return c.name == command; });
    return at == commands.end() ? nullptr : &*at;
}

const OptionOutline* CommandOutline::option(const std::string& wanted) const
{
    for (const OptionOutline& o : options)
        if (std::find(o.names.begin(), o.names.end(), wanted) != o.names.end()) return &o;
    return nullptr;
}

}  // namespace plab::program
