/// Rows in aligned columns that fit the terminal.
#pragma once

#include <string>
#include <vector>

#include "control/console/console.h"

namespace plab::cli
{

enum class Align : unsigned char
{
    Left,
    Right,  ///< numbers
};
/// How a column is shortened on a terminal that is too narrow. Otherwise nothing is shortened, since a program may read the
/// output.
enum class Shrink : unsigned char
{
    Never,
    Middle,  ///< ids, type names: both ends are significant
    End,     ///< prose; on a narrow terminal, the last of these columns are dropped
    Wrap,    ///< prose that is printed in full, over several lines
};

struct Column
{
    std::string title;
    Align align = Align::Left;
    Shrink shrink = Shrink::Never;
    unsigned expendable = 0;  ///< if even shortened columns do not fit, the column with the largest number is dropped first; 0: last
};

class Table
{
public:
    explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}
    /// One cell per column; cells go through printable().
    void add(std::vector<std::string> cells, Style style = Style::Plain);
    bool empty() const { return rows_.empty(); }
    /// Columns that are empty in all rows are omitted. `title` false: rows only, for a stream.
    void print(const Console& console, bool title = true) const;

private:
    struct Row
    {
        std::vector<std::string> cells;
        Style style;
    };
    std::vector<std::size_t> widths(const Console& console) const;
    std::vector<std::size_t> natural_widths() const;
    struct Least
    {
        std::size_t prose, id;
    };
    bool shrink_to(std::size_t most, Least least, std::vector<std::size_t>& widths) const;
    std::vector<std::size_t> in_order_of_leaving() const;
    std::vector<std::vector<std::string>> wrapped(const Row& row, const std::vector<std::size_t>& widths) const;
    std::string cell(std::size_t column, const std::string& text, std::size_t width) const;
    std::string line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) const;

    std::vector<Column> columns_;
    std::vector<Row> rows_;
};

/// Names with their texts in lines, "  name   text": as printed by `show` and for replies.
class Lines
{
public:
    void add(std::string name, std::string text);
    void print(const Console& console) const;

private:
    std::vector<std::pair<std::string, std::string>> lines_;
};

}  // namespace plab::cli
