#include "control/live/local_server.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>

extern char** environ;

namespace plab::cli
{
namespace
{

constexpr std::chrono::milliseconds kCheckInterval(5);  // how late its end may be seen

Error failed(const std::string& what, int code) { return reason(what + ": " + std::strerror(code)); }

std::vector<char*> pointers(std::vector<std::string>& words)
{
    std::vector<char*> out;
    for (std::string& word : words) out.push_back(word.data());
    out.push_back(nullptr);
    return out;
}

/// Where a child's output goes, and that it lives apart from this terminal.
class SpawnPlan
{
public:
    SpawnPlan()
    {
        (void)posix_spawn_file_actions_init(&actions_);
        (void)posix_spawnattr_init(&attributes_);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;
    ~SpawnPlan()
    {
        (void)posix_spawn_file_actions_destroy(&actions_);
        (void)posix_spawnattr_destroy(&attributes_);
    }
    void detach(const std::string& log)
    {
        constexpr int kMode = 0644;
        (void)posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        (void)posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
        (void)posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
        (void)posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSID);
    }
    Result<int> spawn(std::vector<std::string> command)
    {
        pid_t process = 0;
        const int code = posix_spawnp(&process, command.front().c_str(), &actions_, &attributes_, pointers(command).data(), environ);
        if (code != 0) return failed("cannot start " + command.front(), code);
        return process;
    }

private:
    posix_spawn_file_actions_t actions_{};
    posix_spawnattr_t attributes_{};
};

std::vector<std::string> plabd_with(const std::vector<std::string>& arguments)
{
    std::vector<std::string> command{program::program_beside("plabd")};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
}

int code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

}  // namespace

Result<program::Child> start_attached_server(const std::vector<std::string>& arguments)
{
    return program::Child::start(plabd_with(arguments), program::Streams::Shared);
}

Result<int> start_server(const std::vector<std::string>& arguments, const std::string& log)
{
    SpawnPlan plan;
    plan.detach(log);
    return plan.spawn(plabd_with(arguments));
}

Life life_of(int process)
{
    int status = 0;
    if (waitpid(process, &status, WNOHANG) != process) return {true, 0};
    return {false, code_of(status)};
}

Result<int> run_plabd(const std::vector<std::string>& arguments, const link::Stop& stop)
{
    SpawnPlan plan;
    auto process = plan.spawn(plabd_with(arguments));
    if (!process) return process.errors();
    int status = 0;
    bool is_stopping = false;
    for (;;)
    {
        const pid_t ended = waitpid(*process, &status, WNOHANG);
        if (ended == *process) return code_of(status);
        if (ended < 0 && errno != EINTR) return failed("cannot wait for plabd", errno);
        // Ctrl-C reaches both; another signal only this process.
        if (!is_stopping && stop()) is_stopping = kill(*process, SIGTERM) == 0;
        std::this_thread::sleep_for(kCheckInterval);
    }
}

Result<TemporaryFile> TemporaryFile::write(const std::uint8_t* data, std::size_t size)
{
    const char* const folder = std::getenv("TMPDIR");
    std::string path = std::string(folder != nullptr && *folder != '\0' ? folder : "/tmp") + "/plabctl-" + std::string(6, 'X');
    const int file = mkstemp(path.data());
    if (file < 0) return failed("cannot make a file in " + path.substr(0, path.rfind('/')), errno);
    TemporaryFile out(path);
    while (size > 0)
    {
        const ssize_t written = ::write(file, data, size);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0)
        {
            const int code = errno;
            (void)close(file);
            return failed("cannot write " + path, code);
        }
        data += written, size -= static_cast<std::size_t>(written);
    }
    if (close(file) != 0) return failed("cannot write " + path, errno);
    return out;
}

TemporaryFile::~TemporaryFile()
{
    if (!path_.empty()) (void)unlink(path_.c_str());
}

}  // namespace plab::cli
