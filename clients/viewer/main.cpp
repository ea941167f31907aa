/// plab-view: pictures and films of a running scene.
#include <cstdio>

#include "viewer/run.h"

int main(int argc, char** argv)
{
    const plab::view::Interrupt interrupt;
    plab::view::Options options;
    if (const auto end = plab::view::parse_options(argc, argv, options))
    {
        std::fputs(end->message.c_str(), end->code == 0 ? stdout : stderr);
        return end->code;
    }
    const plab::view::Outcome outcome = plab::view::run(options, interrupt);
    if (!outcome.message.empty()) std::fprintf(stderr, "plab-view: %s\n", outcome.message.c_str());
    return static_cast<int>(outcome.exit);
}
