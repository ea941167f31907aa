/// The frame of a report: one self-contained HTML page. Light and dark, printable.
#pragma once

#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "figures/drawing.h"

namespace plab::figures
{

/// A table whose columns can be sorted by a click. A cell: the displayed text, the sort key (empty: the text), a hint.
struct PageCell
{
    std::string text, key, hint;
};

PageCell text_cell(std::string text, std::string hint = {});
/// A measured number, in short form; sorted by all of its digits.
PageCell number_cell(double value, std::string hint = {});
template <class T>
requires std::is_integral_v<T> PageCell whole_cell(T value, std::string hint = {})
{
    const std::string text = std::to_string(value);
    return {text, text, std::move(hint)};
}
/// A value that does not exist: "–", sorted last.
PageCell no_cell(std::string hint = {});
/// The first line of a table without hints.
std::vector<PageCell> text_cells(std::initializer_list<const char*> texts);

class Page
{
public:
    Page(std::string title, std::string lead) : title_(std::move(title)), lead_(std::move(lead)) {}

    void heading(const std::string& text);
    void paragraph(const std::string& text);
    void list(const std::vector<std::string>& items);
    void code(const std::string& text);
    void figure(const Drawing& drawing, const std::string& caption);
    void table(const std::vector<PageCell>& head, const std::vector<std::vector<PageCell>>& rows);
    void facts(const std::vector<std::pair<std::string, std::string>>& facts);
    void link(const std::string& target, const std::string& text);
    std::string html() const;

private:
    std::string title_, lead_, body_;
};

}  // namespace plab::figures
