// plabctl play on a terminal: keys, the bar, and restoring the terminal.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>

#include "support/process.h"
#include "unit/analysis/made_recording.h"

using namespace plab::test;

namespace
{

using Clock = std::chrono::steady_clock;

constexpr tcflag_t kLines = ICANON | ECHO;

/// A program on a terminal whose other end belongs to the test.
class OnTerminal
{
public:
    explicit OnTerminal(std::vector<std::string> command) : master_(posix_openpt(O_RDWR | O_NOCTTY))
    {
        REQUIRE(master_ >= 0);
        REQUIRE(grantpt(master_) == 0);
        REQUIRE(unlockpt(master_) == 0);
        const std::string name = ptsname(master_);
        std::vector<char*> arguments;
        for (std::string& word : command) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        pid_ = fork();
        if (pid_ == 0) become(name, arguments);
    }
    OnTerminal(const OnTerminal&) = delete;
    OnTerminal& operator=(const OnTerminal&) = delete;
    ~OnTerminal()
    {
        if (pid_ > 0) (void)kill(pid_, SIGKILL), (void)waitpid(pid_, nullptr, 0);
        (void)close(master_);
    }

    void type(const std::string& keys) { REQUIRE(write(master_, keys.data(), keys.size()) == static_cast<ssize_t>(keys.size())); }
    /// Waits until this is on the screen, after what was seen before.
    bool shows(const std::string& text)
    {
        const auto end = Clock::now() + std::chrono::seconds(8);
        while (seen_.find(text) == std::string::npos && Clock::now() < end) read_screen();
        const auto at = seen_.find(text);
        if (at == std::string::npos) return false;
        seen_.erase(0, at + text.size());
        return true;
    }
    /// The exit code, or 128 and the signal.
    int end()
    {
        int status = 0;
        const auto end = Clock::now() + std::chrono::seconds(8);
        while (waitpid(pid_, &status, WNOHANG) == 0 && Clock::now() < end) read_screen();
        pid_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    /// Whether it passes on whole lines and echoes input.
    bool has_lines() const
    {
        termios now{};
        REQUIRE(tcgetattr(master_, &now) == 0);
        return (now.c_lflag & kLines) == kLines;
    }
    void stop() const { (void)kill(pid_, SIGTERM); }
    const std::string& seen() const { return seen_; }

private:
    [[noreturn]] static void become(const std::string& terminal, std::vector<char*>& arguments)
    {
        (void)setsid();
        const int slave = open(terminal.c_str(), O_RDWR);
        const winsize size{24, 120, 0, 0};
        (void)ioctl(slave, TIOCSCTTY, 0);
        (void)ioctl(slave, TIOCSWINSZ, &size);
        for (int fd = 0; fd < 3; ++fd) (void)dup2(slave, fd);
        (void)setenv("TERM", "xterm", 1);
        (void)execv(arguments[0], arguments.data());
        _exit(127);
    }
    void read_screen()
    {
        pollfd input{master_, POLLIN, 0};
        std::array<char, 1024> bytes{};
        if (poll(&input, 1, 50) <= 0 || (input.revents & POLLIN) == 0) return;
        const ssize_t got = read(master_, bytes.data(), bytes.size());
        if (got > 0) seen_.append(bytes.data(), static_cast<std::size_t>(got));
    }

    int master_ = -1;
    pid_t pid_ = -1;
    std::string seen_;
};

}  // namespace

TEST_CASE("space, arrows and q work, and the terminal is restored")
{
    MadeOptions made;
    made.steps = 1000;
    const std::string file = make_recording("terminal.mcap", made);
    OnTerminal player({program("plabctl"), "play", file, "--name", unique_name("keys"), "--pause"});
    REQUIRE(player.shows("paused 1x  [>"));
    CHECK_FALSE(player.has_lines());
    player.type("\033[C");
    CHECK(player.shows("1.00 / 10.00 s  t = 1.000 s, run 1"));
    player.type("\033[C\033[C\033[D");
    CHECK(player.shows("2.00 / 10.00 s  t = 2.000 s, run 2"));  // back: a new run
    player.type("\033[A");
    CHECK(player.shows("paused 2x"));
    player.type("\033[B\033[B");
    CHECK(player.shows("paused 0.5x"));
    player.type(" ");
    CHECK(player.shows("\033[K0.5x  [======="));
    player.type("q");
    CHECK(player.end() == 0);
    CHECK_MESSAGE(player.shows(": played as 'keys-"), player.seen());
    CHECK(player.has_lines());
}

TEST_CASE("after Ctrl-C and after SIGTERM the terminal is restored")
{
    const std::string file = make_recording("terminal_2.mcap");
    for (const bool is_typed : {true, false})
    {
        OnTerminal player({program("plabctl"), "play", file, "--name", unique_name("break"), "--loop"});
        REQUIRE(player.shows("1x  ["));
        CHECK_FALSE(player.has_lines());
        is_typed ? player.type("\003") : player.stop();
        CHECK(player.end() == (is_typed ? 130 : 143));
        CHECK(player.has_lines());
    }
}

TEST_CASE("long work shows its progress on a terminal, and Ctrl-C ends it")
{
    OnTerminal study({program("plab-study"), scene_file("studies/stack.xml"), "--vary", "dt=1/960", "--reference", "exact:rest", "--until",
                      "1000", "-o", scratch_file("terminal_study")});
    REQUIRE(study.shows("recording 1 of 1"));
    REQUIRE(study.shows("(Ctrl-C ends)"));
    study.type("\003");
    CHECK(study.end() == 130);
    CHECK_MESSAGE(study.shows("interrupted while recording run 1 of 1"), study.seen());
}
