/// The help of a program with few options and no parser of its own (CLI11 takes long to compile): one outline, written by hand, of which
/// --help, the page of the manual and completion are made.
#pragma once

#include <optional>
#include <string>

#include "program/command_outline.h"

namespace plab::program
{

OptionOutline flag(std::string name, std::string help);
/// "--scenes", "DIR".
OptionOutline option_with(std::string name, std::string value, std::string help);
/// A file that must be named.
OptionOutline place_of_file(std::string name, std::string help);

/// What --help prints.
std::string help_text(const CommandOutline& program);

/// What --help, --version, --print and --complete ask for; nothing: an ordinary command line. Values are completed to names of files.
std::optional<std::string> answer_about(const CommandOutline& program, const std::string& version, int argc, const char* const* argv);

}  // namespace plab::program
