#include "program/installation.h"

#include <filesystem>

namespace plab::program
{

std::string file_or_installed(const std::string& name)
{
    namespace fs = std::filesystem;
    std::error_code failed;
    if (name.empty() || name == "-" || fs::path(name).is_absolute() || fs::exists(name, failed)) return name;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed);
    const fs::path file = (program.parent_path() / "../share/plab" / name).lexically_normal();
    return !failed && fs::is_regular_file(file, failed) ? file.string() : name;
}

}  // namespace plab::program
