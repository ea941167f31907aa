/// The terminal of a user who watches a playback: single keys, and a progress bar.
#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plab::player
{

/// Reads keys, and restores the settings of the terminal afterwards.
class Terminal
{
public:
    /// Standard input, if it is a terminal and this program is in its foreground; otherwise there are no keys.
    Terminal() { set_up(); }
    ~Terminal() { give_back(); }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    /// The keys typed so far, without waiting. When the program was stopped and continues, it sets up the terminal again.
    std::string read();
    void give_back();

private:
    void set_up();

    std::optional<termios> before_;  ///< the original settings; empty: the terminal is not changed
    bool is_given_back_ = false;
};

enum class Key : unsigned char
{
    Pause,    ///< space
    Back,     ///< left: a second
    Forward,  ///< right
    Faster,   ///< up
    Slower,   ///< down
    Quit,     ///< q
};

/// Converts bytes from a terminal to keys. A cursor key has three bytes, which may arrive one by one.
class KeyParser
{
public:
    std::vector<Key> take(std::string_view bytes);

private:
    enum class State : unsigned char
    {
        Plain,
        Escape,
        Sequence,
    };
    State state_ = State::Plain;
};

/// Content of the bar; seconds of the recording's time line.
struct BarState
{
    double from = 0, to = 0, at = 0;
    double rate = 1;
    bool is_paused = false;
    double time = 0;  ///< s, simulated
    unsigned long long run = 0;
};

/// "1x  [=====>------]  3.20 / 10.00 s   t = 3.20 s, run 1   space q arrows", in so many columns.
std::string bar(const BarState& state, std::size_t width);

}  // namespace plab::player
