#include "program/child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>
#include <utility>

namespace plab::program
{
namespace
{

constexpr std::chrono::milliseconds kPatience(2000), kNap(5);
constexpr int kNotRun = 127;  ///< as in shells

Error failed(const std::string& what) { return reason(what + ": " + std::strerror(errno)); }

/// In the child, between fork and exec: only calls that are safe there. `fds`: its standard input, output and error.
[[noreturn]] void become(char* const* words, const std::array<int, 3>& fds, pid_t parent)
{
    (void)prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(kNotRun);  // the parent ended before the kernel knew
    // Copies above the standard ones first: no descriptor is overwritten before it is used.
    std::array<int, 3> high{};
    for (std::size_t i = 0; i < fds.size(); ++i) high[i] = fcntl(fds[i], F_DUPFD, 3);
    for (std::size_t i = 0; i < fds.size(); ++i) (void)dup2(high[i], static_cast<int>(i));
    (void)close_range(3, ~0u, 0);
    (void)execvp(words[0], words);
    const char* const why = std::strerror(errno);
    for (const char* const part : {"cannot run ", static_cast<const char*>(words[0]), ": ", why, "\n"})
        (void)!::write(STDERR_FILENO, part, std::strlen(part));
    _exit(kNotRun);
}

/// What can be read without waiting.
void read_all(int fd, std::string& into)
{
    std::array<char, 4096> bytes{};
    for (ssize_t n = 0; fd >= 0 && (n = ::read(fd, bytes.data(), bytes.size())) > 0;) into.append(bytes.data(), static_cast<std::size_t>(n));
}

}  // namespace

Child::End::End(End&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

Child::End& Child::End::operator=(End&& other) noexcept
{
    std::swap(fd_, other.fd_);
    return *this;
}

Child::End::~End()
{
    if (fd_ >= 0) (void)close(fd_);
}

Result<Child::Pipe> Child::make_pipe()
{
    std::array<int, 2> fds{};
    if (pipe2(fds.data(), O_CLOEXEC) != 0) return failed("cannot make a pipe");
    return Pipe{End(fds[0]), End(fds[1])};
}

Result<Child> Child::start(const std::vector<std::string>& command, Streams streams)
{
    std::vector<std::string> words = command;
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    Child out;
    std::array<Pipe, 3> pipes;
    std::array<int, 3> fds{-1, STDERR_FILENO, STDERR_FILENO};
    End nothing(open("/dev/null", O_RDONLY | O_CLOEXEC));
    fds[0] = nothing.get();
    if (streams == Streams::Piped)
    {
        for (Pipe& pipe : pipes)
        {
            auto made = make_pipe();
            if (!made) return made.errors();
            pipe = made.take();
        }
        fds = {pipes[0][0].get(), pipes[1][1].get(), pipes[2][1].get()};
        out.input_ = std::move(pipes[0][1]), out.output_ = std::move(pipes[1][0]), out.complaints_end_ = std::move(pipes[2][0]);
        for (const End* end : {&out.input_, &out.output_, &out.complaints_end_}) (void)fcntl(end->get(), F_SETFL, O_NONBLOCK);
    }
    const pid_t parent = getpid();
    out.process_ = fork();
    if (out.process_ < 0) return failed("cannot start " + command.front());
    if (out.process_ == 0) become(pointers.data(), fds, parent);
    return out;
}

Child::Child(Child&& other) noexcept
    : process_(std::exchange(other.process_, 0)),
      code_(other.code_),
      input_(std::move(other.input_)),
      output_(std::move(other.output_)),
      complaints_end_(std::move(other.complaints_end_)),
      printed_(std::move(other.printed_)),
      complaints_(std::move(other.complaints_))
{
}

Child::~Child()
{
    if (process_ <= 0 || exit_code()) return;
    ask_to_end();
    for (const auto end = std::chrono::steady_clock::now() + kPatience; std::chrono::steady_clock::now() < end;)
    {
        if (exit_code()) return;
        std::this_thread::sleep_for(kNap);
    }
    (void)kill(process_, SIGKILL);
    (void)waitpid(process_, nullptr, 0);
}

void Child::ask_to_end() const
{
    // A process that was waited for is another one's number by now.
    if (process_ > 0 && !code_) (void)kill(process_, SIGTERM);
}

std::optional<int> Child::exit_code()
{
    int status = 0;
    if (!code_ && process_ > 0 && waitpid(process_, &status, WNOHANG) == process_)
        code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return code_;
}

bool Child::send(const std::string& line) const
{
    const std::string bytes = line + "\n";
    return input_.get() >= 0 && ::write(input_.get(), bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

std::vector<std::string> Child::take_lines()
{
    read_all(output_.get(), printed_);
    std::vector<std::string> out;
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = printed_.find('\n', begin)) != std::string::npos; begin = end + 1)
        out.push_back(printed_.substr(begin, std::min(end - begin, kMostLine)));
    printed_.erase(0, begin);
    if (printed_.size() > kMostLine) printed_.resize(kMostLine);
    return out;
}

const std::string& Child::complaints()
{
    read_all(complaints_end_.get(), complaints_);
    if (complaints_.size() > kMostKept) complaints_.erase(0, complaints_.size() - kMostKept);
    return complaints_;
}

std::string program_beside(const std::string& name)
{
    std::error_code error;
    const std::filesystem::path beside = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / name;
    return !error && std::filesystem::exists(beside, error) ? beside.string() : name;
}

}  // namespace plab::program
