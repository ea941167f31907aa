/// What a command line understands, as plain data: taken out of the parser itself, so that man pages and completion say what --help says.
#pragma once

#include <string>
#include <vector>

namespace plab::program
{

struct OptionOutline
{
    std::vector<std::string> names;  ///< "-o", "--output"; none: known by its place
    std::string place;               ///< "file": its name where it has a place
    std::string value;               ///< what stands for its value in the help, "ID"; "": a flag
    std::vector<std::string> words;  ///< the only values that are taken; none: any
    std::string help, group, fallback;
    bool is_required = false, has_value = false;
    int most = 1;  ///< values one after the other
};

struct CommandOutline
{
    std::string name, help, footer;
    std::vector<OptionOutline> options, places;
    std::vector<CommandOutline> commands;

    const CommandOutline* find(const std::string& command) const;
    const OptionOutline* option(const std::string& name) const;
};

}  // namespace plab::program
