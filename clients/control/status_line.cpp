#include "control/status_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "control/console.h"

namespace plab::control
{
namespace
{

constexpr std::chrono::milliseconds kRefresh(100);
constexpr std::size_t kUsualWidth = 80;

}  // namespace

StatusLine::StatusLine()
{
    const char* const kind = std::getenv("TERM");
    is_terminal_ = isatty(STDERR_FILENO) == 1 && !(kind != nullptr && std::string_view(kind) == "dumb");
    winsize size{};
    width_ = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualWidth;
}

void StatusLine::show(const std::string& text)
{
    if (!is_terminal_) return;
    next_ = std::chrono::steady_clock::now() + kRefresh;
    is_shown_ = true;
    // One column stays free: a full line would move on to the next one.
    std::fprintf(stderr, "\r\033[K%s", shortened_at_end(printable(text), width_ - 1).c_str());
    std::fflush(stderr);
}

void StatusLine::clear()
{
    if (is_shown_) std::fputs("\r\033[K", stderr);
    is_shown_ = false;
}

}  // namespace plab::control
