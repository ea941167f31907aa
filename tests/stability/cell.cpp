#include "cell.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string>

namespace plab::stability
{

namespace
{

constexpr unsigned kWaitFactor = 10;  // of the clock's time to CPU time, on a busy machine

void limit_me(unsigned seconds)
{
    const rlimit cpu{seconds, seconds + 1}, core{0, 0};
    (void)setrlimit(RLIMIT_CPU, &cpu);
    (void)setrlimit(RLIMIT_CORE, &core);
    (void)alarm(kWaitFactor * seconds);
}

bool send(int to, const std::string& text)
{
    for (std::size_t sent = 0; sent < text.size();)
    {
        const ssize_t n = ::write(to, text.data() + sent, text.size() - sent);
        if (n <= 0) return false;
        sent += static_cast<std::size_t>(n);
    }
    return true;
}

std::string receive(int from)
{
    std::string out;
    char buffer[1024];
    for (ssize_t n = 0; (n = ::read(from, buffer, sizeof buffer)) > 0;) out.append(buffer, static_cast<std::size_t>(n));
    return out;
}

Outcome outcome_of(const std::string& line, int status)
{
    if (WIFSIGNALED(status))
    {
        const int signal = WTERMSIG(status);
        const bool time = signal == SIGXCPU || signal == SIGALRM || signal == SIGKILL;
        return {Verdict::Silent, 0, time ? "hangs" : "crashes with signal " + std::to_string(signal), {}};
    }
    const auto outcome = from_line(line);
    return outcome ? *outcome : Outcome{Verdict::Silent, 0, "no answer", {}};
}

}  // namespace

Outcome run_cell(const Case& which, std::size_t algorithm, std::size_t value)
{
    int ends[2];
    if (pipe(ends) != 0) return {Verdict::Silent, 0, "no pipe", {}};
    const pid_t child = fork();
    if (child < 0) return {Verdict::Silent, 0, "no process", {}};
    if (child == 0)
    {
        (void)close(ends[0]);
        limit_me(which.cpu_seconds);
        _exit(send(ends[1], to_line(which.run(algorithm, value))) ? 0 : 1);
    }
    (void)close(ends[1]);
    const std::string line = receive(ends[0]);
    (void)close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    return outcome_of(line, status);
}

}  // namespace plab::stability
