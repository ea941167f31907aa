/// Reads single keys from the terminal, and restores its settings afterwards.
#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>

namespace plab::playback
{

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

}  // namespace plab::playback
