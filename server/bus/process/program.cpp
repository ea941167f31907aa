#include "bus/process/program.h"

#include <fcntl.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "bus/channel/inherited.h"
#include "bus/process/bus_loop.h"
#include "program/plain_help.h"

namespace plab::bus
{
namespace
{

int run(const PipeMemory& memory, WakeEvent& wake, const WakeEvent& server, MakeCompanion make)
{
    // plabd wrote this before it started this process.
    MessageReader reader(PipeReader(memory.down_state(), memory.down()), ~std::uint64_t{0}, false);
    MessageReader::Message message;
    StartMessage start;
    if (reader.next(message) != MessageReader::State::Whole || message.kind != static_cast<std::uint32_t>(Down::Start)) return 1;
    Decoder decoder(message.bytes);
    decoder.get(start);
    if (!decoder.whole()) return 1;
    BusLoop loop(reader, MessageWriter(PipeWriter(memory.up_state(), memory.up())), wake, server, kInheritedLifeline, start);
    if (!loop.join()) return 1;
    // Set after the threads of DDS exist, which must be scheduled at once. Batch: waking this thread does not preempt the step
    // thread on the same core.
    const sched_param priority{};
    (void)pthread_setschedparam(pthread_self(), SCHED_BATCH, &priority);
    std::unique_ptr<Companion> companion;
    if (make != nullptr)
    {
        auto made = make(start);
        if (made)
            companion = made.take();
        else
            std::fprintf(stderr, "plab-bus: %s\n", made.error().text().c_str());
    }
    if (!loop.run()) _exit(1);
    return 0;
}

program::CommandOutline outline(const std::string& name, const std::string& help)
{
    program::CommandOutline out;
    out.name = name, out.help = name + ": " + help;
    out.footer =
        "plabd starts it when it joins the bus, starts it again if it fails, and ends it.\n"
        "It cannot be started by hand and has nothing to set: options of the bus are those of plabd.\n"
        "Exit codes: 0 the server has ended it, 1 it cannot join the bus or go on, 2 it was not started by plabd";
    return out;
}

}  // namespace

int run_program(int argc, char** argv, const std::string& name, const std::string& help, MakeCompanion make)
{
    if (argc > 1)
        if (const auto answer = program::answer_about(outline(name, help), PLAB_VERSION, argc, argv))
            return std::fputs(answer->c_str(), stdout) < 0 ? 1 : 0;
    // plabd ends this process: a signal to the whole process group must not close the bus before clients have been informed of
    // the end.
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) (void)std::signal(signal, SIG_IGN);
    (void)std::signal(SIGPIPE, SIG_IGN);
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    auto memory = PipeMemory::attach(kInheritedMemory);
    if (argc != 1 || !memory)
    {
        const std::string why = memory ? "" : " (" + memory.error().text() + ")";
        return std::fprintf(stderr, "%s is started by plabd only%s\n", name.c_str(), why.c_str()), 2;
    }
    for (int fd = kInheritedFirst; fd < kInheritedEnd; ++fd) (void)fcntl(fd, F_SETFD, FD_CLOEXEC);
    WakeEvent wake(kInheritedWake);
    const WakeEvent server(kInheritedServer);
    return run(*memory, wake, server, make);
}

}  // namespace plab::bus
