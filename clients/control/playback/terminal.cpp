#include "control/playback/terminal.h"

#include <poll.h>
#include <unistd.h>

#include <array>

namespace plab::playback
{
namespace
{

constexpr tcflag_t kLines = ICANON | ECHO;

}  // namespace

void Terminal::set_up()
{
    // In the background, changing the terminal would stop the program.
    if (is_given_back_ || isatty(STDIN_FILENO) != 1 || tcgetpgrp(STDIN_FILENO) != getpgrp()) return;
    termios now{};
    if (tcgetattr(STDIN_FILENO, &now) != 0 || (now.c_lflag & kLines) == 0) return;
    before_ = now;
    now.c_lflag &= ~kLines;
    now.c_cc[VMIN] = 1, now.c_cc[VTIME] = 0;
    (void)tcsetattr(STDIN_FILENO, TCSADRAIN, &now);
}

std::string Terminal::read()
{
    set_up();
    if (!before_ || tcgetpgrp(STDIN_FILENO) != getpgrp()) return {};
    std::array<char, 64> bytes{};
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, 0) <= 0 || (input.revents & POLLIN) == 0) return {};
    const ssize_t got = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    return got > 0 ? std::string(bytes.data(), static_cast<std::size_t>(got)) : std::string();
}

void Terminal::give_back()
{
    if (before_ && !is_given_back_) (void)tcsetattr(STDIN_FILENO, TCSADRAIN, &*before_);
    is_given_back_ = true;
}

}  // namespace plab::playback
