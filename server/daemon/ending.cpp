#include "daemon/ending.h"

#include <cstdio>

namespace plab::daemon
{

int fail(const Errors& errors)
{
    for (const Error& e : errors) (void)std::fprintf(stderr, "%s\n", e.text().c_str());
    return 1;
}

}  // namespace plab::daemon
