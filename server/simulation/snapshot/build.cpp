#include "simulation/snapshot/build.h"

#include <gnu/libc-version.h>

#include <array>
#include <cstdio>

#include "plab/plugin.h"

namespace plab::simulation
{
namespace
{

/// The features by which glibc selects its variants of sin, exp and other functions.
std::string processor_features()
{
    std::string out;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) out += " avx2";
    if (__builtin_cpu_supports("fma")) out += " fma";
    if (__builtin_cpu_supports("fma4")) out += " fma4";
#endif
    return out.empty() ? " plain" : out;
}

}  // namespace

std::string build_name()
{
    std::array<char, 24> layout{};
    (void)std::snprintf(layout.data(), layout.size(), "%016llx", static_cast<unsigned long long>(layout_stamp()));
    return "plab " PLAB_VERSION ", sdk " + std::to_string(kSdkVersion) + ", compiler " __VERSION__ ", flags " PLAB_BUILD_FLAGS ", layout " +
           layout.data() + ", libc " + ::gnu_get_libc_version() + ", processor" + processor_features();
}

}  // namespace plab::simulation
