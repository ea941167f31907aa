#include "bus/bus_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "bus/channel/inherited.h"

namespace plab::bus
{
namespace
{

constexpr std::chrono::milliseconds kCheckInterval(100);  ///< interval of checks for a stopped process while a caller waits for its end

/// A descriptor that closes itself.
class Descriptor
{
public:
    explicit Descriptor(int fd = -1) : fd_(fd) {}
    ~Descriptor()
    {
        if (fd_ >= 0) (void)close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return fd_; }
    int release() { return std::exchange(fd_, -1); }

private:
    int fd_;
};

/// A copy with a number above those that the process inherits, so that none is overwritten before it is passed on.
int copy_above(int fd) { return fcntl(fd, F_DUPFD_CLOEXEC, kInheritedEnd); }

/// Starts the program with these descriptors as kInheritedMemory and so on; the process id, or a negative error number.
pid_t spawn(const std::string& program, const std::array<int, kInheritedEnd - kInheritedFirst>& inherited)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    (void)posix_spawn_file_actions_init(&actions);
    (void)posix_spawnattr_init(&attributes);
    (void)posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    (void)posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    for (std::size_t i = 0; i < inherited.size(); ++i)
        (void)posix_spawn_file_actions_adddup2(&actions, inherited[i], kInheritedFirst + static_cast<int>(i));
    (void)posix_spawn_file_actions_addclosefrom_np(&actions, kInheritedEnd);
    sigset_t none, all;
    (void)sigemptyset(&none), (void)sigfillset(&all);
    (void)posix_spawnattr_setsigmask(&attributes, &none);
    (void)posix_spawnattr_setsigdefault(&attributes, &all);
    // Does not inherit the scheduling class of the thread that starts it: data that DDS receives must be handled at once.
    const sched_param priority{};
    (void)posix_spawnattr_setschedpolicy(&attributes, SCHED_OTHER);
    (void)posix_spawnattr_setschedparam(&attributes, &priority);
    (void)posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSCHEDULER);
    std::string name = "plab-bus";
    std::array<char*, 2> arguments{name.data(), nullptr};
    pid_t pid = -1;
    const int error = posix_spawn(&pid, program.c_str(), &actions, &attributes, arguments.data(), environ);
    (void)posix_spawn_file_actions_destroy(&actions);
    (void)posix_spawnattr_destroy(&attributes);
    return error == 0 ? pid : -error;
}

}  // namespace

std::string bus_program(bool with_ros)
{
    if (const char* given = std::getenv("PLAB_BUS_PROGRAM"); given != nullptr && *given != 0) return given;
    std::error_code error;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
    const char* const name = with_ros ? "plab-bus-ros" : "plab-bus";
    return error ? name : (self.parent_path() / name).string();
}

BusProcess::BusProcess(PipeMemory memory, WakeEvent wake)
    : memory_(std::move(memory)),
      wake_(std::move(wake)),
      writer_(PipeWriter(memory_.down_state(), memory_.down())),
      reader_(PipeReader(memory_.up_state(), memory_.up()), kMostUp, true)
{
}

Result<std::unique_ptr<BusProcess>> BusProcess::start(const std::string& program, const WakeEvent& wake, const StartMessage& start)
{
    auto memory = PipeMemory::make();
    if (!memory) return memory.errors();
    std::unique_ptr<BusProcess> process(new BusProcess(memory.take(), WakeEvent::make()));
    std::array<int, 2> ends{-1, -1};
    if (process->wake_.descriptor() < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) != 0)
        return reason(std::string("cannot start plab-bus: ") + std::strerror(errno));
    process->lifeline_ = ends[0];
    const Descriptor other_end(ends[1]);
    const Descriptor memory_copy(copy_above(process->memory_.descriptor())), wake_copy(copy_above(process->wake_.descriptor())),
        our_wake(copy_above(wake.descriptor())), line(copy_above(other_end.get()));
    // The pipe is empty, and this fits.
    (void)process->writer_.send(Down::Start, start);
    const pid_t pid = spawn(program, {memory_copy.get(), wake_copy.get(), our_wake.get(), line.get()});
    if (pid < 0) return reason("cannot start " + program + ": " + std::strerror(-pid));
    process->pid_ = pid;
    return process;
}

BusProcess::~BusProcess()
{
    if (pid_ > 0 && ended().empty())
    {
        (void)kill(pid_, SIGKILL);
        (void)waitpid(pid_, &status_, 0);
    }
    if (lifeline_ >= 0) (void)close(lifeline_);
}

std::string BusProcess::ended()
{
    while (!is_gone_ && waitpid(pid_, &status_, WNOHANG | WUNTRACED | WCONTINUED) == pid_)
    {
        is_stopped_ = WIFSTOPPED(status_);
        is_gone_ = WIFSIGNALED(status_) || WIFEXITED(status_);
    }
    if (!is_gone_) return {};
    if (WIFSIGNALED(status_)) return "was ended by signal " + std::to_string(WTERMSIG(status_)) + " (" + strsignal(WTERMSIG(status_)) + ")";
    return "ended with exit code " + std::to_string(WEXITSTATUS(status_));
}

bool BusProcess::wait(std::chrono::milliseconds longest)
{
    const auto end = std::chrono::steady_clock::now() + longest;
    while (ended().empty())
    {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        if (left.count() <= 0 || is_stopped_) return false;
        pollfd watched{lifeline_, POLLIN, 0};
        // The socket closes a moment before the process can be waited for.
        if (poll(&watched, 1, static_cast<int>(std::min(left, kCheckInterval).count())) > 0) (void)usleep(500);
    }
    return true;
}

}  // namespace plab::bus
