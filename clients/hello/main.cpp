// plab-hello: the smallest subscriber. Prints time and position of the first body a few times. README.md walks through.
#include <cstdio>
#include <cstdlib>

#include "link/frame_reader.h"

int main(int argc, char** argv)
{
    using namespace plab;
    const bool has_count = argc == 3 && std::string(argv[1]) == "-n";
    const int count = has_count ? std::atoi(argv[2]) : 5;
    if ((argc != 1 && !has_count) || count < 1) return std::fputs("usage: plab-hello [-n COUNT]\n", stderr), 2;

    auto options = link::options_from_environment();
    if (!options) return std::fprintf(stderr, "plab-hello: %s\n", options.error().text().c_str()), 2;
    auto session = link::Session::find(*options, link::Seconds(5));
    if (!session) return std::fprintf(stderr, "plab-hello: %s\n", session.error().text().c_str()), 3;
    auto frames = link::FrameReader::open(*session);
    if (!frames) return std::fprintf(stderr, "plab-hello: %s\n", frames.error().text().c_str()), 1;

    int printed = 0;
    const auto print = [&](const plab_v2_Frame& frame)
    {
        if (frame.bodies._length == 0 || printed == count) return;
        const plab_v2_BodyState& body = frame.bodies._buffer[0];
        std::printf("%8.3f s  body %u  %8.3f %8.3f %8.3f m\n", frame.time, body.handle, body.position.x, body.position.y, body.position.z);
        ++printed;
    };
    while (printed < count && session->wait(*frames, link::Seconds(2))) (void)frames->take(print);
    if (printed == count) return 0;
    return std::fputs("plab-hello: no frame with a body for 2 s; is the server paused?\n", stderr), 3;
}
