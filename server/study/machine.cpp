// The machine on which the timings were measured.
#include <sys/utsname.h>

#include <fstream>

#include "study/study.h"

namespace plab::study
{

Machine describe_machine()
{
    Machine out;
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; out.processor.empty() && std::getline(info, line);)
        if (line.starts_with("model name") && line.find(": ") != std::string::npos) out.processor = line.substr(line.find(": ") + 2);
    if (out.processor.empty()) out.processor = "unknown processor";
    utsname name{};
    if (uname(&name) == 0) out.system = std::string(name.sysname) + " " + name.release + " " + name.machine;
    out.compiler = PLAB_COMPILER, out.flags = PLAB_FLAGS, out.version = PLAB_VERSION;
    return out;
}

}  // namespace plab::study
