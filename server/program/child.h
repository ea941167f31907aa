/// A program that this one starts, and that ends with it, however this one ends: the kernel sends the child SIGTERM when the thread that
/// started it has gone. So start() belongs on a thread that lives as long as the child should.
///
///   auto child = Child::start({"plabctl", "record"}, Streams::Piped);
///   while (!child->exit_code()) for (const std::string& line : child->take_lines()) use(line);
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "plab/result.h"

namespace plab::program
{

enum class Streams : unsigned char
{
    Piped,   ///< all three to this program
    Shared,  ///< no input; both outputs to this program's standard error
};

class Child
{
public:
    /// The first word is looked for in PATH if it has no '/'. That the program cannot be run is an exit code of 127, and a complaint.
    static Result<Child> start(const std::vector<std::string>& command, Streams streams);
    Child(Child&& other) noexcept;
    Child& operator=(Child&&) = delete;
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    /// Asks it to end, waits at most two seconds, and kills it.
    ~Child();

    int process() const { return process_; }
    void ask_to_end() const;  ///< SIGTERM
    /// Nothing while it runs; then its code, or 128 + the signal that ended it.
    std::optional<int> exit_code();

    /// One line for its standard input. Never waits; false: it takes none. This program must ignore SIGPIPE, as catch_signals() does.
    bool send(const std::string& line) const;
    /// Complete lines that it has printed; one of more than kMostLine bytes is cut.
    std::vector<std::string> take_lines();
    /// The last kMostKept bytes of what it has written to standard error.
    const std::string& complaints();

    static constexpr std::size_t kMostLine = 1u << 20, kMostKept = 8u << 10;  ///< bytes

private:
    /// A descriptor, closed with the object.
    class End
    {
    public:
        End() = default;
        explicit End(int fd) : fd_(fd) {}
        End(End&& other) noexcept;
        End& operator=(End&& other) noexcept;
        ~End();
        int get() const { return fd_; }

    private:
        int fd_ = -1;
    };
    using Pipe = std::array<End, 2>;  ///< what is written to [1] is read from [0]

    Child() = default;
    static Result<Pipe> make_pipe();

    int process_ = 0;
    std::optional<int> code_;
    End input_, output_, complaints_end_;
    std::string printed_, complaints_;
};

/// `name` beside this program, or as PATH finds it.
std::string program_beside(const std::string& name);

}  // namespace plab::program
