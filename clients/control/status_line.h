/// One line on standard error that is written again and again, where that is a terminal; elsewhere nothing.
#pragma once

#include <chrono>
#include <string>

namespace plab::control
{

class StatusLine
{
public:
    StatusLine();
    ~StatusLine() { clear(); }
    StatusLine(const StatusLine&) = delete;
    StatusLine& operator=(const StatusLine&) = delete;

    bool is_terminal() const { return is_terminal_; }
    /// Columns of the terminal.
    std::size_t width() const { return width_; }
    /// Ten times a second.
    bool is_due() const { return is_terminal_ && std::chrono::steady_clock::now() >= next_; }
    void show(const std::string& text);
    void clear();

private:
    bool is_terminal_ = false, is_shown_ = false;
    std::size_t width_ = 0;
    std::chrono::steady_clock::time_point next_;
};

}  // namespace plab::control
