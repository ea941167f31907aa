#include "support/process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

namespace plab::test
{
namespace
{

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string text_of(const std::string& file)
{
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

/// In the child, between fork and exec.
void become(const std::vector<std::string>& command, const std::vector<std::string>& environment, const std::string& output,
            const std::string& errors)
{
    // It does not outlive a test that crashes.
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const std::string& entry : environment)
    {
        const std::size_t equal = entry.find('=');
        if (equal == std::string::npos)
            unsetenv(entry.c_str());
        else
            setenv(entry.substr(0, equal).c_str(), entry.substr(equal + 1).c_str(), 1);
    }
    const int out = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err = open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int in = open("/dev/null", O_RDONLY);
    dup2(in, STDIN_FILENO), dup2(out, STDOUT_FILENO), dup2(err, STDERR_FILENO);
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execvp(arguments[0], arguments.data());
    _exit(127);
}

}  // namespace

std::string program(const std::string& name) { return std::string(PLAB_BINARY_DIR) + "/bin/" + name; }
std::string scene_file(const std::string& name) { return std::string(PLAB_SOURCE_DIR) + "/scenes/" + name; }

std::string scratch_file(const std::string& name)
{
    const fs::path folder = fs::path(PLAB_BINARY_DIR) / "test_files" / std::to_string(getpid());
    fs::create_directories(folder);
    return (folder / name).string();
}

std::string unique_name(const std::string& stem)
{
    static std::atomic<int> count{0};
    return stem + "-" + std::to_string(getpid()) + "-" + std::to_string(++count);
}

Process::Process(std::vector<std::string> command, const std::vector<std::string>& environment)
{
    static std::atomic<int> count{0};
    const std::string stem = fs::path(command.front()).filename().string() + "_" + std::to_string(++count);
    output_file_ = scratch_file(stem + ".out"), errors_file_ = scratch_file(stem + ".err");
    pid_ = fork();
    if (pid_ == 0) become(command, environment, output_file_, errors_file_);
}

Process::Process(Process&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), code_(other.code_), output_file_(other.output_file_), errors_file_(other.errors_file_)
{
}

Process::~Process()
{
    if (pid_ > 0 && running())
    {
        kill(pid_, SIGCONT);
        kill(pid_, SIGKILL);
        (void)wait(Milliseconds(5000));
    }
}

void Process::signal(int number) const
{
    if (pid_ > 0) kill(pid_, number);
}

bool Process::running() { return wait(Milliseconds(0)) == -1; }

int Process::wait(Milliseconds timeout)
{
    const auto end = Clock::now() + timeout;
    while (code_ < 0 && pid_ > 0)
    {
        int status = 0;
        if (waitpid(pid_, &status, WNOHANG) == pid_)
        {
            code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
            break;
        }
        if (Clock::now() >= end) break;
        std::this_thread::sleep_for(Milliseconds(2));
    }
    return code_;
}

std::string Process::output() const { return text_of(output_file_); }
std::string Process::errors() const { return text_of(errors_file_); }

bool Process::wait_for(const std::string& text, Milliseconds timeout)
{
    const auto end = Clock::now() + timeout;
    while (true)
    {
        const bool ended = !running();
        if (output().find(text) != std::string::npos || errors().find(text) != std::string::npos) return true;
        if (ended || Clock::now() >= end) return false;
        std::this_thread::sleep_for(Milliseconds(5));
    }
}

Outcome run(std::vector<std::string> command, Milliseconds timeout, const std::vector<std::string>& environment)
{
    Process process(std::move(command), environment);
    Outcome out;
    out.code = process.wait(timeout);
    out.output = process.output(), out.errors = process.errors();
    return out;
}

double cpu_seconds(int pid)
{
    const std::string stat = text_of("/proc/" + std::to_string(pid) + "/stat");
    const std::size_t name_end = stat.rfind(')');
    if (name_end == std::string::npos) return 0;
    std::istringstream fields(stat.substr(name_end + 2));
    std::string word;
    for (int i = 0; i < 11; ++i) fields >> word;  // state to cmajflt
    double user = 0, system = 0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

int threads_of(int pid)
{
    int count = 0;
    std::error_code failed;
    for (auto it = fs::directory_iterator("/proc/" + std::to_string(pid) + "/task", failed); !failed && it != fs::directory_iterator();
         ++it)
        ++count;
    return count;
}

bool maps(int pid, const std::string& name)
{
    std::ifstream in("/proc/" + std::to_string(pid) + "/maps");
    for (std::string line; std::getline(in, line);)
        if (const std::size_t path = line.find('/'); path != std::string::npos && line.find(name, path) != std::string::npos) return true;
    return false;
}

}  // namespace plab::test
