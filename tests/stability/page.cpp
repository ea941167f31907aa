#include "page.h"

#include <array>
#include <cstdio>
#include <sstream>

namespace plab::stability
{

namespace
{

std::string figure(const Outcome& cell)
{
    char text[32];
    std::snprintf(text, sizeof text, cell.figure < kRounding ? "~0" : "%.0e", cell.figure);
    return text;
}

constexpr std::size_t kLineWidth = 130;

/// Breaks a paragraph into lines; `indent` of the second and later ones.
std::string wrapped(const std::string& paragraph, std::size_t indent = 0)
{
    std::istringstream words(paragraph);
    std::string out, word;
    for (std::size_t column = 0; words >> word;)
    {
        const bool is_first = out.empty(), fits = column + 1 + word.size() <= kLineWidth;
        if (!is_first) out += fits ? " " : "\n" + std::string(indent, ' ');
        column = is_first || fits ? column + (is_first ? 0 : 1) + word.size() : indent + word.size();
        out += word;
    }
    return out + "\n";
}

/// The text of a case: what is simulated, then as list entries how the error is measured and which errors count as stable and bounded.
std::string description(const Case& c)
{
    const std::size_t error = c.text.find("Error: "), bounds = c.text.find("Stable to ");
    return wrapped(c.text.substr(0, error)) + "\n" + wrapped("- " + c.text.substr(error, bounds - error), 2) +
           wrapped("- " + c.text.substr(bounds), 2);
}

/// Why a cell is not stable, as a footnote number: equal reasons share one.
class Notes
{
public:
    std::string mark(const std::string& reason)
    {
        if (reason.empty()) return "";
        std::size_t i = 0;
        while (i < reasons_.size() && reasons_[i] != reason) ++i;
        if (i == reasons_.size()) reasons_.push_back(reason);
        return " (" + std::to_string(i + 1) + ")";
    }
    std::string text() const
    {
        std::string out;
        for (std::size_t i = 0; i < reasons_.size(); ++i) out += std::to_string(i + 1) + ". " + reasons_[i] + "\n";
        return out.empty() ? out : out + "\n";
    }

private:
    std::vector<std::string> reasons_;
};

std::string cell_text(const Outcome* cell, Notes& notes)
{
    if (!cell) return "not run";
    std::string out;
    if (cell->verdict == Verdict::Stable) return figure(*cell);
    if (cell->verdict == Verdict::Degraded) out = "*degraded* " + figure(*cell);
    if (cell->verdict == Verdict::Refused) out = "refused";
    if (cell->verdict == Verdict::Diverged) out = "**diverged**";
    if (cell->verdict == Verdict::Silent) out = "**SILENT** " + figure(*cell);
    return out + notes.mark(reason_of(*cell));
}

std::string section(const Case& c, const Table& table)
{
    std::string out = "## " + c.title + "\n\n" + description(c) + "\n| " + c.algorithm + " \\ " + c.parameter + " |", line = "|---|";
    for (const std::string& v : c.values) out += " " + v + " |", line += "---|";
    out += "\n" + line + "\n";
    Notes notes;
    for (std::size_t r = 0; r < c.algorithms.size(); ++r)
    {
        out += "| " + c.algorithms[r] + " |";
        for (std::size_t v = 0; v < c.values.size(); ++v) out += " " + cell_text(table.find(key_of(c, r, v)), notes) + " |";
        out += "\n";
    }
    return out + "\n" + notes.text();
}

std::string summary(const std::vector<Case>& cases, const Table& table)
{
    std::array<int, 5> counts{};
    for (const Case& c : cases)
        for (std::size_t r = 0; r < c.algorithms.size(); ++r)
            for (std::size_t v = 0; v < c.values.size(); ++v)
                if (const Outcome* cell = table.find(key_of(c, r, v))) ++counts[static_cast<std::size_t>(cell->verdict)];
    std::string out;
    for (std::size_t k = 0; k < counts.size(); ++k)
        out += (k == 0 ? "" : ", ") + std::to_string(counts[k]) + " " + std::string(name_of(static_cast<Verdict>(k)));
    return out;
}

}  // namespace

std::string page(const std::vector<Case>& cases, const Table& table)
{
    std::string out = "# Stability: stiff and extreme cases\n\n";
    out += wrapped(
        "What each algorithm does where things get stiff, fast, tiny, huge or senseless. Written by `build/bin/stability --write "
        "server/docs/stability.md` from `tests/stability/expected.txt`; a test compares that table with what is measured.");
    out +=
        "\nHow to read a cell:\n\n| cell | meaning |\n|---|---|\n"
        "| a number | stable; the number is its error, and `~0` is below 1e-11 |\n"
        "| *degraded* | finite and bounded, but the error exceeds the bound for stable, or there was a warning |\n"
        "| refused | not accepted, with a message |\n"
        "| **diverged** | beyond all bounds, and an event reported it |\n"
        "| **SILENT** | beyond all bounds without an event, a hang or a crash: a defect |\n"
        "| a note with *slow* | the cell's budget of force evaluations was used up at about that share of the time |\n\n"
        "Events that report a failure, beside those of the component that failed, such as `solver.gave_up` or `contact.stiff`:\n\n"
        "| event | meaning |\n|---|---|\n"
        "| `state.not_finite` | an object left the range of numbers in which a step can compute (1e150); it is put back to the start of "
        "the "
        "step |\n"
        "| `motion.diverged` | the energy is a hundred times what was present or added, or a speed keeps doubling every few steps; the "
        "motion "
        "continues, but its numbers are meaningless |\n"
        "| `force.stiff` | forces on bodies in contact change too fast even for the parts into which their island divides the step |\n"
        "| `contact.missed` | a body passed through another between two detections; its centre of mass is checked, so a corner that passes "
        "is not noticed |\n"
        "| `contact.deep` | bodies remain deep inside one another, where impulses or rows should hold them |\n\n"
        "The energy is counted anew after each request.\n\nCells: " +
        summary(cases, table) + ".\n\n";
    for (const Case& c : cases) out += section(c, table);
    out.pop_back();
    return out;
}

}  // namespace plab::stability
