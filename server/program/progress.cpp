#include "program/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace plab::program
{
namespace
{

constexpr std::chrono::milliseconds kRefresh(100);
constexpr std::chrono::seconds kBetweenLines(5);
constexpr std::size_t kUsualWidth = 80, kBarWidth = 30;

bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }

/// Limits the text to a number of columns, and removes control characters.
std::string one_line(const std::string& text, std::size_t most)
{
    std::string out;
    std::size_t columns = 0;
    for (const char c : text)
    {
        if (begins_character(c) && ++columns > most) break;
        const auto byte = static_cast<unsigned char>(c);
        out += byte < 0x20 || byte == 0x7f ? '?' : c;
    }
    return out;
}

}  // namespace

Progress::Progress(ProgressTo to, std::chrono::milliseconds after) : start_(Clock::now())
{
    const char* const kind = std::getenv("TERM");
    const bool is_one = isatty(STDERR_FILENO) == 1 && !(kind != nullptr && std::string_view(kind) == "dumb");
    is_terminal_ = is_one && to != ProgressTo::Nowhere;
    is_lines_ = !is_one && to == ProgressTo::Lines;
    next_ = start_ + (is_lines_ ? std::max<Clock::duration>(after, kBetweenLines) : Clock::duration(after));
    winsize size{};
    width_ = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualWidth;
}

void Progress::show(const std::string& text)
{
    if (!is_terminal_ && !is_lines_) return;
    next_ = Clock::now() + (is_terminal_ ? Clock::duration(kRefresh) : Clock::duration(kBetweenLines));
    if (is_lines_)
    {
        std::fprintf(stderr, "%s\n", one_line(text, std::string::npos).c_str());
        return;
    }
    is_shown_ = true;
    // One column stays free: a full line would wrap to the next one.
    std::fprintf(stderr, "\r\033[K%s", one_line(text, width_ - 1).c_str());
    std::fflush(stderr);
}

void Progress::show_share(const std::string& what, double share)
{
    if (!is_due()) return;
    const std::string left = time_left(share, std::chrono::duration<double>(Clock::now() - start_).count());
    show(what + "  " + bar(share, kBarWidth) + (left.empty() ? "" : ", " + left));
}

void Progress::clear()
{
    if (is_shown_) std::fputs("\r\033[K", stderr);
    is_shown_ = false;
}

std::string bar(double share, std::size_t width)
{
    const double part = share > 0 ? std::min(1.0, share) : 0.0;
    const auto full = static_cast<std::size_t>(part * static_cast<double>(width));
    char percent[16];
    std::snprintf(percent, sizeof percent, "] %3.0f %%", std::floor(100 * part));
    return "[" + std::string(full, '#') + std::string(width - full, '.') + percent;
}

std::string time_left(double share, double seconds_passed)
{
    constexpr double kLeastShare = 0.02;
    if (!(share > kLeastShare) || !(share < 1) || !(seconds_passed > 1)) return {};
    const double left = std::ceil(seconds_passed / share * (1 - share));
    char text[48];
    if (left < 120)
        std::snprintf(text, sizeof text, "about %.0f s left", left);
    else if (left < 7200)
        std::snprintf(text, sizeof text, "about %.0f min left", std::ceil(left / 60));
    else
        std::snprintf(text, sizeof text, "about %.1f h left", left / 3600);
    return text;
}

}  // namespace plab::program
