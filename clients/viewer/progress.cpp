#include "viewer/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace plab::view
{
namespace
{

using Clock = std::chrono::steady_clock;

constexpr auto kLongWork = std::chrono::seconds(1);
constexpr auto kRefresh = std::chrono::milliseconds(100);
constexpr std::size_t kBarWidth = 30;

bool is_terminal()
{
    const char* const kind = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && !(kind != nullptr && std::string_view(kind) == "dumb");
}

}  // namespace

std::string bar(std::uint64_t done, std::uint64_t total, std::size_t width)
{
    const double share = total > 0 ? std::min(1.0, static_cast<double>(done) / static_cast<double>(total)) : 1.0;
    const auto full = static_cast<std::size_t>(share * static_cast<double>(width));
    char percent[16];
    std::snprintf(percent, sizeof percent, "] %3.0f %%", 100 * share);
    return "[" + std::string(full, '#') + std::string(width - full, '.') + percent;
}

Progress::Progress(std::string what) : what_(std::move(what)), terminal_(is_terminal()), start_(Clock::now()), next_(start_ + kLongWork) {}

void Progress::update(std::uint64_t done, std::optional<std::uint64_t> total, double time)
{
    const auto now = Clock::now();
    if (!terminal_ || now < next_) return;
    next_ = now + kRefresh;
    shown_ = true;
    const std::string head = total ? bar(done, *total, kBarWidth) + "  " : "";
    std::fprintf(stderr, "\r\033[K%s%llu %s, t = %.2f s", head.c_str(), static_cast<unsigned long long>(done), what_.c_str(), time);
}

void Progress::clear()
{
    if (shown_) std::fputs("\r\033[K", stderr);
    shown_ = false;
}

void Progress::say(const std::string& message)
{
    clear();
    std::fprintf(stderr, "plab-view: %s\n", message.c_str());
}

void Progress::finish(std::uint64_t done)
{
    clear();
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    std::fprintf(stderr, "%llu %s, %.1f s\n", static_cast<unsigned long long>(done), what_.c_str(), seconds);
}

}  // namespace plab::view
