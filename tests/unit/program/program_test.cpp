// The effect of signals on a program that catches them, and the text of a progress line.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <string>

#include "program/interruption.h"
#include "program/progress.h"

using namespace plab::program;

namespace
{

/// The exit code of a child that runs `body`; 1000 + the number of the signal that killed it.
template <class Body>
int code_of_child(Body body)
{
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0)
    {
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) (void)::signal(signal, SIG_DFL);
        catch_signals();
        _exit(body());
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

}  // namespace

TEST_CASE("a signal sets the flag, and the exit code is 128 + the number of the first one")
{
    CHECK(code_of_child([] { return is_interrupted() || !name_of_interruption().empty() ? 1 : code_of_interruption(); }) == 0);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        CHECK(code_of_child(
                  [signal]
                  {
                      (void)raise(signal);
                      return is_interrupted() && interruption() ? code_of_interruption() : 1;
                  }) == 128 + signal);
    CHECK(code_of_child(
              []
              {
                  (void)raise(SIGTERM);
                  (void)raise(SIGTERM);  // as from `timeout`: to the process, and to its group
                  (void)raise(SIGINT);
                  return name_of_interruption() == "SIGTERM" ? code_of_interruption() : 1;
              }) == 143);
}

TEST_CASE("a second signal, later, ends a program that does not end by itself")
{
    CHECK(code_of_child(
              []
              {
                  (void)raise(SIGINT);
                  (void)usleep(600'000);
                  (void)raise(SIGINT);
                  return 0;
              }) == 1000 + SIGINT);
}

TEST_CASE("a signal wakes a thread that waits on an eventfd; SIGPIPE does not end the program")
{
    CHECK(code_of_child(
              []
              {
                  const int descriptor = eventfd(0, EFD_NONBLOCK);
                  wake_on_signal(descriptor);
                  (void)raise(SIGPIPE);
                  std::uint64_t count = 0;
                  if (read(descriptor, &count, sizeof count) > 0) return 1;
                  (void)raise(SIGTERM);
                  return read(descriptor, &count, sizeof count) == sizeof count && count == 1 ? 7 : 2;
              }) == 7);
}

TEST_CASE("a signal ignored by nohup stays ignored")
{
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0)
    {
        (void)::signal(SIGHUP, SIG_IGN);
        catch_signals();
        (void)raise(SIGHUP);
        _exit(is_interrupted() ? 1 : 0);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK(status == 0);
}

TEST_CASE("a bar shows the fraction done, and the remaining time once it can be estimated")
{
    CHECK(bar(0.25, 8) == "[##......]  25 %");
    CHECK(bar(2.25, 4) == "[####] 100 %");
    CHECK(bar(0.999, 4) == "[###.]  99 %");
    CHECK(bar(-1, 2) == "[..]   0 %");
    CHECK(time_left(0.01, 100).empty());
    CHECK(time_left(0.5, 0.5).empty());
    CHECK(time_left(0.25, 10) == "about 30 s left");
    CHECK(time_left(0.1, 100) == "about 15 min left");
    CHECK(time_left(0.1, 3600) == "about 9.0 h left");
}
