/// The terminal, while single keys are read from it. It is given back as it was.
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
    Terminal() { look(); }
    ~Terminal() { give_back(); }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    /// What has been typed, without waiting. A program that was stopped and goes on takes the terminal again.
    std::string read();
    void give_back();

private:
    void look();

    std::optional<termios> before_;  ///< as it was; none: it is not ours
    bool is_given_back_ = false;
};

}  // namespace plab::playback
