#include "control/console/console.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace plab::cli
{
namespace
{

constexpr std::size_t kUsualWidth = 80;

bool is_set(const char* name)
{
    const char* const value = std::getenv(name);
    return value != nullptr && *value != 0;
}

std::size_t terminal_width()
{
    winsize size{};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    const char* const columns = std::getenv("COLUMNS");
    std::size_t width = 0;
    if (columns != nullptr) (void)std::from_chars(columns, columns + std::strlen(columns), width);
    return width > 0 ? width : kUsualWidth;
}

std::size_t terminal_height()
{
    winsize size{};
    return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_row : 0;
}

bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }

/// The first `most` characters of UTF-8 text.
std::string_view head(std::string_view text, std::size_t most)
{
    std::size_t at = 0, seen = 0;
    for (; at < text.size(); ++at)
        if (begins_character(text[at]) && seen++ == most) break;
    return text.substr(0, at);
}

std::string_view tail(std::string_view text, std::size_t most)
{
    return text.substr(head(text, columns_of(text) - std::min(most, columns_of(text))).size());
}

std::string formatted(const char* format, double value)
{
    char buffer[64];
    return {buffer, static_cast<std::size_t>(std::snprintf(buffer, sizeof buffer, format, value))};
}

}  // namespace

Console Console::make(const std::string& color)
{
    Console c;
    c.is_terminal_ = isatty(STDOUT_FILENO) == 1;
    c.width_ = c.is_terminal_ ? terminal_width() : 0;
    c.height_ = c.is_terminal_ ? terminal_height() : 0;
    const char* const term = std::getenv("TERM");
    const bool can = c.is_terminal_ && !is_set("NO_COLOR") && (term == nullptr || std::string_view(term) != "dumb");
    c.is_colored_ = color == "always" || (color == "auto" && can);
    return c;
}

std::string Console::styled(Style style, std::string_view text) const
{
    static constexpr const char* kCodes[] = {"", "1", "2", "31", "32", "33", "36"};
    if (!is_colored_ || style == Style::Plain || text.empty()) return std::string(text);
    return "\x1b[" + std::string(kCodes[static_cast<std::size_t>(style)]) + "m" + std::string(text) + "\x1b[0m";
}

void Console::out(std::string_view text) const { (void)std::fwrite(text.data(), 1, text.size(), stdout); }

bool Console::flush() const { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

void Console::say(std::string_view text) const
{
    (void)std::fflush(stdout);  // in the order of writing, where both go to one place
    (void)std::fwrite(text.data(), 1, text.size(), stderr);
    (void)std::fputc('\n', stderr);
}

std::string printable(std::string_view text)
{
    std::string out;
    for (const char c : text)
    {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\n')
            out += "\\n";
        else if (c == '\t')
            out += ' ';
        else if (byte < 0x20 || byte == 0x7f)
            out += '?';
        else
            out += c;
    }
    return out;
}

std::size_t columns_of(std::string_view text)
{
    std::size_t n = 0;
    for (const char c : text) n += begins_character(c) ? 1u : 0u;
    return n;
}

std::string shortened_in_middle(std::string_view text, std::size_t most)
{
    if (columns_of(text) <= most) return std::string(text);
    if (most <= 4) return std::string(head(text, most));
    const std::size_t kept = most - 2, front = kept / 2;
    return std::string(head(text, front)) + ".." + std::string(tail(text, kept - front));
}

std::string shortened_at_end(std::string_view text, std::size_t most)
{
    if (columns_of(text) <= most) return std::string(text);
    return most <= 2 ? std::string(head(text, most)) : std::string(head(text, most - 2)) + "..";
}

std::string number(double value) { return formatted("%.6g", value); }
std::string exact_number(double value) { return formatted("%.9g", value); }

std::string duration_text(double ns)
{
    const double size = std::fabs(ns);
    if (!std::isfinite(ns) || size < 1000) return formatted("%.3g ns", ns);
    if (size < 1e6) return formatted("%.1f us", ns / 1e3);
    if (size < 1e9) return formatted("%.2f ms", ns / 1e6);
    return formatted("%.2f s", ns / 1e9);
}

std::string bytes_text(double bytes)
{
    if (bytes < 1e3) return formatted("%.0f B", bytes);
    if (bytes < 1e6) return formatted("%.1f kB", bytes / 1e3);
    return bytes < 1e9 ? formatted("%.1f MB", bytes / 1e6) : formatted("%.2f GB", bytes / 1e9);
}

std::string bytes_text(std::uint64_t bytes) { return bytes_text(static_cast<double>(bytes)); }

std::string age_text(double seconds)
{
    const auto s = static_cast<long long>(std::max(0.0, seconds));
    if (s < 60) return std::to_string(s) + " s";
    if (s < 3600) return std::to_string(s / 60) + " min " + std::to_string(s % 60) + " s";
    return std::to_string(s / 3600) + " h " + std::to_string(s / 60 % 60) + " min";
}

}  // namespace plab::cli
