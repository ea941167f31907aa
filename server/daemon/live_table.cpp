#include "daemon/live_table.h"

#include <unistd.h>

#include <cstdio>

#include "daemon/output.h"

namespace plab::daemon
{
namespace
{

constexpr std::size_t kLines = 6;

std::string stamped(double time, const std::string& text)
{
    char stamp[32];
    std::snprintf(stamp, sizeof stamp, "%10.4f s  ", time);
    return stamp + text;
}

}  // namespace

std::string event_text(const simulation::Simulation& s, const Event& e)
{
    std::string text = e.kind;
    if (e.component != kNoIndex) text += " " + s.world().id_of(e.component);
    if (e.a.valid() && e.b.valid()) text += " (" + s.world().id_of(e.a) + ", " + s.world().id_of(e.b) + ")";
    if (!e.message.empty()) text += ": " + e.message;
    return text;
}

LiveTable::LiveTable(bool wanted, std::string footer) : wanted_(wanted), terminal_(isatty(STDOUT_FILENO) != 0), footer_(std::move(footer))
{
}

void LiveTable::note(const simulation::Simulation& s)
{
    if (!wanted_) return;
    for (const Event& e : s.events()) note(stamped(e.time, event_text(s, e)));
}

void LiveTable::note(std::string line)
{
    if (!wanted_) return;
    if (!terminal_)
    {
        std::printf("%s\n", line.c_str());
        return;
    }
    lines_.push_back(std::move(line));
    if (lines_.size() > kLines) lines_.pop_front();
}

void LiveTable::show(const simulation::Simulation& s, bool last)
{
    if (!wanted_) return;
    const auto now = std::chrono::steady_clock::now();
    const bool due = terminal_ ? now - shown_ > std::chrono::milliseconds(100) : s.time() >= next_;
    if (!due && !last) return;
    shown_ = now;
    while (next_ <= s.time()) next_ += 1.0;
    std::string text = table_text(s);
    if (!lines_.empty()) text += "latest events\n";
    for (const std::string& line : lines_) text += "  " + line + "\n";
    if (terminal_ && !footer_.empty()) text += footer_ + "\n";
    if (terminal_) std::fputs("\x1b[H\x1b[J", stdout);
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

}  // namespace plab::daemon
