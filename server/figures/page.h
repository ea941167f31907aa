/// The frame of a report: one self-contained HTML page. Light and dark, printable.
#pragma once

#include <string>
#include <vector>

#include "figures/drawing.h"

namespace plab::figures
{

/// A table whose columns can be sorted by a click. A cell: the displayed text, the sort key (empty: the text), a hint.
struct PageCell
{
    std::string text, key, hint;
};

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
