/// Progress of long work: one line on standard error that is redrawn in place on a terminal; otherwise nothing, or, if
/// requested, a line every few seconds.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace plab::program
{

enum class ProgressTo : std::uint8_t
{
    Terminal,  ///< on standard error, if it is a terminal
    Lines,     ///< the same; otherwise a line every five seconds
    Nowhere,
};

class Progress
{
public:
    using Clock = std::chrono::steady_clock;

    /// Nothing is shown before `after`: short work needs no progress bar.
    explicit Progress(ProgressTo to = ProgressTo::Terminal, std::chrono::milliseconds after = std::chrono::seconds(1));
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    bool is_terminal() const { return is_terminal_; }
    /// Columns of the terminal.
    std::size_t width() const { return width_; }
    /// Ten times per second on a terminal, otherwise every five seconds.
    bool is_due() const { return (is_terminal_ || is_lines_) && Clock::now() >= next_; }
    /// Prints one line now, shortened to the terminal's width. Control characters become '?'.
    void show(const std::string& text);
    /// If it is due: "WHAT  [#####.....]  50 %, about 3 s left".
    void show_share(const std::string& what, double share);
    /// Removes the line; call it before anything else is written.
    void clear();

private:
    bool is_terminal_ = false, is_lines_ = false, is_shown_ = false;
    std::size_t width_ = 0;
    Clock::time_point start_, next_;
};

/// "[#####.....]  50 %", with `width` places.
std::string bar(double share, std::size_t width);
/// "about 3 s left", "about 2 min left"; "" while it is too early to estimate.
std::string time_left(double share, double seconds_passed);

}  // namespace plab::program
