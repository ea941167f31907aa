/// What lies beside the program where it is installed.
#pragma once

#include <string>

namespace plab::program
{

/// `name` as it is, if there is such a file; else the one of share/plab, where there is one: "scenes/fan_and_balloons.xml" is found from
/// any folder. Absolute names and "-" stay.
std::string file_or_installed(const std::string& name);

}  // namespace plab::program
