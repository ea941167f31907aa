/// A program's page of the manual, in the language of troff (man 7 man), from what its parser understands.
#pragma once

#include <string>

#include "program/command_outline.h"

namespace plab::program
{

/// `more`: text that the help has behind its options. Of it and of the footer words before a colon ("Exit codes: 0 done") become titles.
std::string man_page(const CommandOutline& program, const std::string& version, const std::string& more = {});

}  // namespace plab::program
