/// How far long work is: one line on standard error that is written again and again where that is a terminal; elsewhere nothing,
/// or a line every few seconds for who asks for it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace plab::program
{

enum class ProgressTo : std::uint8_t
{
    Terminal,  ///< standard error, if it is one
    Lines,     ///< the same; and where it is none, a line every five seconds
    Nowhere,
};

class Progress
{
public:
    using Clock = std::chrono::steady_clock;

    /// Nothing is shown before `after`: work that is done by then needs no bar.
    explicit Progress(ProgressTo to = ProgressTo::Terminal, std::chrono::milliseconds after = std::chrono::seconds(1));
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    bool is_terminal() const { return is_terminal_; }
    /// Columns of the terminal.
    std::size_t width() const { return width_; }
    /// Ten times a second on a terminal, else every five seconds.
    bool is_due() const { return (is_terminal_ || is_lines_) && Clock::now() >= next_; }
    /// Now, due or not: one line, cut to the terminal's width. Control characters become '?'.
    void show(const std::string& text);
    /// If it is due: "WHAT  [#####.....]  50 %, about 3 s left".
    void show_share(const std::string& what, double share);
    /// Takes the line away: before anything else is written.
    void clear();

private:
    bool is_terminal_ = false, is_lines_ = false, is_shown_ = false;
    std::size_t width_ = 0;
    Clock::time_point start_, next_;
};

/// "[#####.....]  50 %", with `width` places.
std::string bar(double share, std::size_t width);
/// "about 3 s left", "about 2 min left"; "" where it is too early to tell.
std::string time_left(double share, double seconds_passed);

}  // namespace plab::program
