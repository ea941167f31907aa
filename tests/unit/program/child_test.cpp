// A program that is started and ends with the one that started it.
#include "program/child.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "program/interruption.h"

using namespace plab::program;
using namespace std::chrono_literals;

namespace
{

template <class Condition>
bool within(std::chrono::milliseconds longest, Condition condition)
{
    for (const auto end = std::chrono::steady_clock::now() + longest; std::chrono::steady_clock::now() < end;)
    {
        if (condition()) return true;
        std::this_thread::sleep_for(5ms);
    }
    return condition();
}

Child started(const std::vector<std::string>& command, Streams streams = Streams::Piped)
{
    auto child = Child::start(command, streams);
    REQUIRE_MESSAGE(child.ok(), child.error().text());
    return child.take();
}

bool is_there(int process) { return kill(process, 0) == 0; }

}  // namespace

TEST_CASE("what is sent to a child, what it prints and what it complains about arrive, and its exit code")
{
    Child child = started({"sh", "-c", "read line; echo \"got $line\"; echo one; printf half; echo trouble >&2; exit 7"});
    CHECK_FALSE(child.exit_code());
    CHECK(child.send("a b"));
    REQUIRE(within(5s, [&] { return child.exit_code().has_value(); }));
    CHECK(*child.exit_code() == 7);
    CHECK(child.take_lines() == std::vector<std::string>{"got a b", "one"});
    CHECK(child.complaints() == "trouble\n");
    ignore_write_signals();
    CHECK_FALSE(child.send("nobody reads this"));
    (void)signal(SIGPIPE, SIG_DFL);
}

TEST_CASE("a program that cannot be run is an exit code and a complaint that names it")
{
    Child child = started({"/nowhere/plabctl", "x"});
    REQUIRE(within(5s, [&] { return child.exit_code().has_value(); }));
    CHECK(*child.exit_code() == 127);
    CHECK(child.complaints() == "cannot run /nowhere/plabctl: No such file or directory\n");
}

TEST_CASE("what a child writes is bounded, however much it is")
{
    Child child = started({"sh", "-c", "head -c 300000 /dev/zero | tr '\\0' e >&2; echo last >&2"});
    REQUIRE(within(10s, [&] { return child.complaints().ends_with("last\n"); }));
    CHECK(child.complaints().size() <= Child::kMostKept);
}

TEST_CASE("a child inherits no descriptor but the three")
{
    Child child = started({"sh", "-c", "ls /proc/self/fd | wc -l"});
    REQUIRE(within(5s, [&] { return child.exit_code().has_value(); }));
    CHECK(child.take_lines() == std::vector<std::string>{"4"});  // the fourth is that of the folder which ls reads
}

TEST_CASE("a child ends with its object, also one that does not want to")
{
    int gentle = 0, stubborn = 0;
    {
        Child first = started({"sleep", "60"});
        Child second = started({"sh", "-c", "trap '' TERM; echo ready; while :; do sleep 0.1; done"});
        REQUIRE(within(5s, [&] { return !second.take_lines().empty(); }));
        gentle = first.process(), stubborn = second.process();
        CHECK(is_there(gentle));
        first.ask_to_end();
        REQUIRE(within(2s, [&] { return first.exit_code().has_value(); }));
        CHECK(*first.exit_code() == 128 + SIGTERM);
    }
    CHECK_FALSE(is_there(gentle));
    CHECK_FALSE(is_there(stubborn));  // waited for, so no zombie either
}

TEST_CASE("a child ends when its parent is killed")
{
    int fds[2];
    REQUIRE(pipe(fds) == 0);
    const pid_t parent = fork();
    REQUIRE(parent >= 0);
    if (parent == 0)
    {
        // Not before it runs: a child that finds no parent then ends for that reason.
        auto child = Child::start({"sh", "-c", "echo ready; exec sleep 60"}, Streams::Piped);
        const bool is_ready = child && within(5s, [&] { return !child->take_lines().empty(); });
        const int process = is_ready ? child->process() : 0;
        (void)!::write(fds[1], &process, sizeof process);
        for (;;) pause();
    }
    int process = 0;
    REQUIRE(::read(fds[0], &process, sizeof process) == sizeof process);
    REQUIRE(process > 0);
    CHECK(is_there(process));
    (void)kill(parent, SIGKILL);
    (void)waitpid(parent, nullptr, 0);
    // Whoever adopts it may take a moment to wait for it: what counts is that it runs no more.
    const auto has_ended = [&]
    {
        const std::string stat = "/proc/" + std::to_string(process) + "/stat";
        std::FILE* const file = std::fopen(stat.c_str(), "r");
        char state = 'Z';
        if (file != nullptr) (void)!std::fscanf(file, "%*d %*s %c", &state), (void)std::fclose(file);
        return state == 'Z';
    };
    CHECK(within(5s, has_ended));
    for (const int fd : fds) (void)close(fd);
}
