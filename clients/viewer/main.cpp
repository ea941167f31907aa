/// plab-view: pictures and films of a running scene.
#include <cstdio>

#include "program/interruption.h"
#include "viewer/run.h"

int main(int argc, char** argv)
{
    plab::program::catch_signals();
    plab::view::ViewerOptions options;
    if (const auto end = plab::view::parse_options(argc, argv, options))
    {
        std::fputs(end->text.c_str(), end->exit_code == 0 ? stdout : stderr);
        return end->exit_code;
    }
    const plab::view::Outcome outcome = plab::view::run(options, plab::program::is_interrupted);
    if (!outcome.message.empty()) std::fprintf(stderr, "plab-view: %s\n", outcome.message.c_str());
    if (outcome.exit == plab::view::Exit::Interrupted) return plab::program::code_of_interruption();
    return static_cast<int>(outcome.exit);
}
