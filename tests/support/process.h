/// A program in a process of its own: started, watched, ended, with its output in a file.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace plab::test
{

using Milliseconds = std::chrono::milliseconds;

/// Ends with the object at the latest (SIGKILL), so that no test leaves a process behind.
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
    /// What it has written so far.
    std::string output() const;
    std::string errors() const;
    /// Until its output (or errors) holds `text`. False after `timeout` or when it ended without.
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
/// Runs a program to its end; killed after `timeout` (code -1).
Outcome run(std::vector<std::string> command, Milliseconds timeout = Milliseconds(20000), const std::vector<std::string>& environment = {});

/// CPU time of a process and its threads so far, s.
double cpu_seconds(int pid);
/// Number of its threads.
int threads_of(int pid);
/// Whether one of its mapped files has `name` in its path.
bool maps(int pid, const std::string& name);

/// build/bin/NAME.
std::string program(const std::string& name);
/// scenes/NAME.
std::string scene_file(const std::string& name);
/// A file of this test's own in the build folder.
std::string scratch_file(const std::string& name);
/// A server name that no other test uses at the same time.
std::string unique_name(const std::string& stem);

}  // namespace plab::test
