/// A program in a separate process: started, observed, ended, with its output in a file.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace plab::test
{

using Milliseconds = std::chrono::milliseconds;

/// The process is ended (SIGKILL) at the latest when the object is destroyed, so that no test leaves a process behind.
class Process
{
public:
    /// `command`: program and arguments; `environment`: "NAME=value", or "NAME" to unset. Output and errors go to files.
    explicit Process(std::vector<std::string> command, const std::vector<std::string>& environment = {});
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    Process(Process&& other) noexcept;
    ~Process();

    int pid() const { return pid_; }
    void signal(int number) const;
    /// The exit code (128 + n after signal n), or -1 if it still runs after `timeout`.
    int wait(Milliseconds timeout);
    bool running();
    /// Its output so far.
    std::string output() const;
    std::string errors() const;
    /// Waits until its output (or error output) contains `text`. Returns false after `timeout`, or if the process has ended
    /// without it.
    bool wait_for(const std::string& text, Milliseconds timeout);

private:
    int pid_ = -1;
    int code_ = -1;
    std::string output_file_, errors_file_;
};

struct Outcome
{
    int code = -1;
    std::string output, errors;
};
/// Runs a program to its end; kills it after `timeout` (code -1).
Outcome run(std::vector<std::string> command, Milliseconds timeout = Milliseconds(20000), const std::vector<std::string>& environment = {});

/// CPU time of a process and its threads so far, s.
double cpu_seconds(int pid);
/// The number of its threads.
int threads_of(int pid);
/// Whether one of its memory-mapped files has `name` in its path.
bool maps(int pid, const std::string& name);

/// build/bin/NAME.
std::string program(const std::string& name);
/// scenes/NAME.
std::string scene_file(const std::string& name);
/// A file of this test alone, in the build folder.
std::string scratch_file(const std::string& name);
/// A server name that no other test uses at the same time.
std::string unique_name(const std::string& stem);

}  // namespace plab::test
