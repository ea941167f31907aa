#include "control/console/table.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace plab::cli
{
namespace
{

constexpr std::size_t kGap = 2;
// Minimum widths of columns when they shrink. Ids shrink further only when no prose is left to shrink.
constexpr std::size_t kLeastProse = 16, kLeastId = 20, kLeastShortId = 12, kLeastAtAll = 8;

std::size_t total(const std::vector<std::size_t>& widths)
{
    std::size_t sum = 0;
    for (const std::size_t w : widths) sum += w > 0 ? w + kGap : 0;
    return sum > 0 ? sum - kGap : 0;
}

/// Takes as many words off the front of `text` as fit in `most` columns; a word that is too long is split.
std::string take_line(std::string& text, std::size_t most)
{
    if (columns_of(text) <= most) return std::exchange(text, {});
    std::size_t end = text.rfind(' ', most);
    if (end == std::string::npos || end == 0 || columns_of(text.substr(0, end)) > most)
        for (end = 0; end < text.size() && columns_of(text.substr(0, end + 1)) <= most;) ++end;
    std::string line = text.substr(0, end);
    text.erase(0, end + (text[end] == ' ' ? 1 : 0));
    return line;
}

}  // namespace

void Table::add(std::vector<std::string> cells, Style style)
{
    assert(cells.size() == columns_.size());
    for (std::string& c : cells) c = printable(c);
    rows_.push_back({std::move(cells), style});
}

std::vector<std::size_t> Table::natural_widths() const
{
    std::vector<std::size_t> out(columns_.size(), 0);
    for (const Row& row : rows_)
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::max(out[i], columns_of(row.cells[i]));
    for (std::size_t i = 0; i < out.size(); ++i)
        if (out[i] > 0) out[i] = std::max(out[i], columns_of(columns_[i].title));
    return out;
}

/// Narrows the widest column by one at a time, so that they end up alike; prose first. True if it fits then.
bool Table::shrink_to(std::size_t most, Least kept, std::vector<std::size_t>& widths) const
{
    for (const bool prose : {true, false})
        while (total(widths) > most)
        {
            const std::size_t least = prose ? kept.prose : kept.id;
            std::size_t widest = widths.size();
            for (std::size_t i = 0; i < widths.size(); ++i)
            {
                const Shrink kind = columns_[i].shrink;
                const bool may = prose ? kind == Shrink::End || kind == Shrink::Wrap : kind == Shrink::Middle;
                if (may && widths[i] > least && (widest == widths.size() || widths[i] > widths[widest])) widest = i;
            }
            if (widest == widths.size()) break;
            --widths[widest];
        }
    return total(widths) <= most;
}

/// Columns that may be dropped: prose from the last, then expendable ones, then all but the first from the last.
std::vector<std::size_t> Table::in_order_of_leaving() const
{
    std::vector<std::size_t> out(columns_.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = out.size() - 1 - i;
    out.pop_back();
    const auto rank = [&](std::size_t i)
    { return columns_[i].shrink == Shrink::End ? std::numeric_limits<unsigned>::max() : columns_[i].expendable; };
    std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) { return rank(a) > rank(b); });
    return out;
}

std::vector<std::size_t> Table::widths(const Console& console) const
{
    std::vector<std::size_t> natural = natural_widths(), out = natural;
    if (console.width() == 0 || shrink_to(console.width(), {kLeastProse, kLeastId}, out)) return out;
    // Prose that is printed in full is never shortened: a line that is too long is better.
    const bool wraps = std::any_of(columns_.begin(), columns_.end(), [](const Column& c) { return c.shrink == Shrink::Wrap; });
    for (const std::size_t i : in_order_of_leaving())
    {
        const bool is_prose = columns_[i].shrink == Shrink::End;
        if (wraps && !is_prose) break;
        if (out = natural; !is_prose && shrink_to(console.width(), {kLeastProse, kLeastShortId}, out)) return out;
        natural[i] = 0, out = natural;
        if (shrink_to(console.width(), {kLeastProse, is_prose ? kLeastId : kLeastShortId}, out)) return out;
    }
    (void)shrink_to(console.width(), {kLeastAtAll, kLeastAtAll}, out);
    return out;
}

/// The row's cells line by line: all but those that wrap are in the first.
std::vector<std::vector<std::string>> Table::wrapped(const Row& row, const std::vector<std::size_t>& widths) const
{
    std::vector<std::vector<std::string>> lines{row.cells};
    for (std::size_t i = 0; i < columns_.size(); ++i)
    {
        if (columns_[i].shrink != Shrink::Wrap || widths[i] == 0) continue;
        std::string rest = row.cells[i];
        for (std::size_t n = 0; n == 0 || !rest.empty(); ++n)
        {
            if (n == lines.size()) lines.emplace_back(columns_.size());
            lines[n][i] = take_line(rest, widths[i]);
        }
    }
    return lines;
}

std::string Table::cell(std::size_t column, const std::string& text, std::size_t width) const
{
    const bool in_middle = columns_[column].shrink == Shrink::Middle;
    const std::string shown = in_middle ? shortened_in_middle(text, width) : shortened_at_end(text, width);
    const std::string padding(width - std::min(width, columns_of(shown)), ' ');
    return columns_[column].align == Align::Right ? padding + shown : shown + padding;
}

std::string Table::line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) const
{
    std::string out;
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (widths[i] > 0) out += (out.empty() ? "" : std::string(kGap, ' ')) + cell(i, cells[i], widths[i]);
    out.erase(out.find_last_not_of(' ') + 1);
    return out;
}

void Table::print(const Console& console, bool title) const
{
    if (rows_.empty()) return;
    const std::vector<std::size_t> wide = widths(console);
    if (title)
    {
        std::vector<std::string> titles;
        for (const Column& c : columns_) titles.push_back(c.title);
        console.out(console.styled(Style::Bold, line(titles, wide)) + "\n");
    }
    for (const Row& row : rows_)
        for (const std::vector<std::string>& cells : wrapped(row, wide)) console.out(console.styled(row.style, line(cells, wide)) + "\n");
}

void Lines::add(std::string name, std::string text)
{
    if (!text.empty()) lines_.emplace_back(printable(name), printable(text));
}

void Lines::print(const Console& console) const
{
    std::size_t width = 0;
    for (const auto& [name, text] : lines_) width = std::max(width, columns_of(name));
    for (const auto& [name, text] : lines_)
        console.out("  " + console.styled(Style::Dim, name) + std::string(width - columns_of(name) + kGap, ' ') + text + "\n");
}

}  // namespace plab::cli
