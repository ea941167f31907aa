#include "control/table.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace plab::control
{
namespace
{

constexpr std::size_t kGap = 2;
constexpr std::size_t kLeast = 8;  // what a column keeps when it shrinks

std::size_t total(const std::vector<std::size_t>& widths)
{
    std::size_t sum = 0;
    for (const std::size_t w : widths) sum += w > 0 ? w + kGap : 0;
    return sum > 0 ? sum - kGap : 0;
}

}  // namespace

void Table::add(std::vector<std::string> cells, Style style)
{
    assert(cells.size() == columns_.size());
    for (std::string& c : cells) c = printable(c);
    rows_.push_back({std::move(cells), style});
}

std::vector<std::size_t> Table::widths(const Console& console) const
{
    std::vector<std::size_t> out(columns_.size(), 0);
    for (const Row& row : rows_)
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::max(out[i], columns_of(row.cells[i]));
    for (std::size_t i = 0; i < out.size(); ++i)
        if (out[i] > 0) out[i] = std::max(out[i], columns_of(columns_[i].title));
    if (console.width() == 0) return out;
    // Prose gives way first, then ids; the widest of them by one column at a time, so that they end up alike.
    for (const Shrink kind : {Shrink::End, Shrink::Middle})
        while (total(out) > console.width())
        {
            std::size_t widest = out.size();
            for (std::size_t i = 0; i < out.size(); ++i)
                if (columns_[i].shrink == kind && out[i] > kLeast && (widest == out.size() || out[i] > out[widest])) widest = i;
            if (widest == out.size()) break;
            --out[widest];
        }
    return out;
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
    for (const Row& row : rows_) console.out(console.styled(row.style, line(row.cells, wide)) + "\n");
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

}  // namespace plab::control
