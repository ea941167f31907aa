#include "control/recording/player/terminal.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

namespace plab::player
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

namespace
{

constexpr char kEscape = '\033';

std::optional<Key> plain_key(char c)
{
    if (c == ' ') return Key::Pause;
    if (c == 'q' || c == 'Q') return Key::Quit;
    return {};
}

std::optional<Key> cursor_key(char c)
{
    if (c == 'A') return Key::Faster;
    if (c == 'B') return Key::Slower;
    if (c == 'C') return Key::Forward;
    if (c == 'D') return Key::Back;
    return {};
}

template <class... Values>
std::string formatted(const char* format, Values... values)
{
    std::array<char, 96> text{};
    (void)std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

}  // namespace

std::vector<Key> KeyParser::take(std::string_view bytes)
{
    std::vector<Key> out;
    for (const char c : bytes)
    {
        std::optional<Key> key;
        if (c == kEscape)
            state_ = State::Escape;
        else if (state_ == State::Escape && (c == '[' || c == 'O'))
            state_ = State::Sequence;
        else
        {
            // A letter behind a lone escape was typed with Alt.
            if (state_ == State::Sequence) key = cursor_key(c);
            if (state_ == State::Plain) key = plain_key(c);
            // Other keys send numbers before their letter: "ESC [ 5 ~".
            const bool goes_on = state_ == State::Sequence && (c == ';' || (c >= '0' && c <= '9'));
            if (!goes_on) state_ = State::Plain;
        }
        if (key) out.push_back(*key);
    }
    return out;
}

std::string bar(const BarState& s, std::size_t width)
{
    constexpr std::size_t kLeastBar = 10, kMostBar = 40;
    const std::string head = s.is_paused ? formatted("paused %gx  ", s.rate) : formatted("%gx  ", s.rate);
    const std::string tail = formatted("  %.2f / %.2f s  t = %.3f s, run %llu", s.at, s.to, s.time, s.run);
    const std::string keys = "  (space, arrows, q)";
    const std::size_t words = head.size() + tail.size() + 2;
    const std::size_t room = width > words ? width - words : 0;
    const bool has_keys = room >= kLeastBar + keys.size();
    const std::size_t length = std::min(kMostBar, has_keys ? room - keys.size() : room);
    if (length < kLeastBar) return head + tail;
    const double share = s.to > s.from ? std::clamp((s.at - s.from) / (s.to - s.from), 0.0, 1.0) : 1.0;
    const auto full = static_cast<std::size_t>(share * static_cast<double>(length - 1));
    return head + "[" + std::string(full, '=') + ">" + std::string(length - 1 - full, '.') + "]" + tail + (has_keys ? keys : "");
}

}  // namespace plab::player
