// plab-bus: the one process of a server that maps DDS. plabd starts it, and starts it again when it ends; nobody else does.
#include <fcntl.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "bus/channel/inherited.h"
#include "bus/process/bus_loop.h"

namespace
{

using namespace plab::bus;

int run(const PipeMemory& memory, Bell& bell, const Bell& server)
{
    // Written by plabd before it started this process.
    MessageReader reader(PipeReader(memory.down_state(), memory.down()), ~std::uint64_t{0}, false);
    MessageReader::Message message;
    StartMessage start;
    if (reader.next(message) != MessageReader::State::Whole || message.kind != static_cast<std::uint32_t>(Down::Start)) return 1;
    Decoder decoder(message.bytes);
    decoder.get(start);
    if (!decoder.whole()) return 1;
    BusLoop loop(reader, MessageWriter(PipeWriter(memory.up_state(), memory.up())), bell, server, kInheritedLifeline, start);
    if (!loop.join()) return 1;
    // After those of DDS, which are to be woken at once. Batch: it does not push the step thread aside when it is woken on the same core.
    const sched_param priority{};
    (void)pthread_setschedparam(pthread_self(), SCHED_BATCH, &priority);
    if (!loop.run()) _exit(1);
    return 0;
}

}  // namespace

int main(int argc, char**)
{
    // plabd ends it: a signal to the whole group must not take the bus away before clients have heard the end.
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) (void)std::signal(signal, SIG_IGN);
    (void)std::signal(SIGPIPE, SIG_IGN);
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (argc != 1 || fcntl(kInheritedLifeline, F_GETFD) < 0)
        return std::fputs("plab-bus is started by plabd, and by nobody else\n", stderr), 2;
    for (int fd = kInheritedFirst; fd < kInheritedEnd; ++fd) (void)fcntl(fd, F_SETFD, FD_CLOEXEC);
    auto memory = PipeMemory::attach(kInheritedMemory);
    if (!memory) return std::fprintf(stderr, "plab-bus: %s\n", memory.error().text().c_str()), 1;
    Bell bell(kInheritedBell);
    const Bell server(kInheritedServer);
    return run(*memory, bell, server);
}
