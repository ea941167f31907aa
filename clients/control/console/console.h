/// The terminal: colours, width, numbers for people. Data goes to standard output, messages to standard error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace plab::cli
{

enum class Style : unsigned char
{
    Plain,
    Bold,
    Dim,
    Red,
    Green,
    Yellow,
    Cyan,
};

class Console
{
public:
    /// `color`: "auto" (a terminal, NO_COLOR not set, TERM not "dumb"), "always", "never".
    static Console make(const std::string& color);

    bool is_terminal() const { return is_terminal_; }
    /// Columns of a line; 0: unlimited, if standard output is not a terminal.
    std::size_t width() const { return width_; }
    /// Lines of the terminal; 0: unlimited or unknown.
    std::size_t height() const { return height_; }
    std::string styled(Style style, std::string_view text) const;

    /// Standard output. The caller handles control characters: text from the bus must go through printable().
    void out(std::string_view text) const;
    /// Also flushes: for streams, and at the end of a command. False if the reader is gone (a closed pipe).
    bool flush() const;
    /// A message on standard error.
    void say(std::string_view text) const;

private:
    bool is_terminal_ = false, is_colored_ = false;
    std::size_t width_ = 0, height_ = 0;
};

/// Foreign text without control characters, so that it cannot move the cursor or colour the terminal.
std::string printable(std::string_view text);
/// Columns that UTF-8 text takes, one per character.
std::size_t columns_of(std::string_view text);
/// "very_long_name" as "very_..name" in `most` columns.
std::string shortened_in_middle(std::string_view text, std::size_t most);
/// "some text" as "some te.." in `most` columns.
std::string shortened_at_end(std::string_view text, std::size_t most);

/// Six significant digits: "0.0021", "1.5e-07".
std::string number(double value);
/// Nine significant digits, for values that are compared.
std::string exact_number(double value);
/// "12.4 us", "3.1 ms".
std::string duration_text(double nanoseconds);
/// "512 B", "1.4 MB".
std::string bytes_text(double bytes);
std::string bytes_text(std::uint64_t bytes);
/// "5 min 12 s".
std::string age_text(double seconds);

}  // namespace plab::cli
