#include "page.h"

#include <array>
#include <cstdio>

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
    return out + notes.mark(cell->how);
}

std::string section(const Case& c, const Table& table)
{
    std::string out = "## " + c.title + "\n\n" + c.text + "\n\n| " + c.algorithm + " \\ " + c.parameter + " |", line = "|---|";
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
    std::string out =
        "# Stability: stiff and extreme cases\n\n"
        "What each algorithm does where things get stiff, fast, tiny, huge or senseless. Written by `build/bin/stability --write "
        "server/docs/stability.md` from `tests/stability/expected.txt`; a test holds that table against what is measured.\n\n"
        "A number alone is a stable cell and its error. *Degraded*: finite and bounded, but wrong by more than the case's bound, or with a "
        "warning. *Refused*: not accepted, with a message. **Diverged**: beyond all bounds, and the named event said so. **SILENT**: "
        "beyond all "
        "bounds without a word, a hang or a crash; a defect. `~0` is below 1e-11. *Slow*: the cell's budget of force evaluations was used "
        "up.\n\n"
        "Events that report a failure, beside those of the component that failed (`solver.gave_up`, `constraint.contradiction`, "
        "`contact.stiff`, `script.error` ...):\n\n"
        "- `state.not_finite`: an object left the range of numbers that a step can compute with (1e150); it is put back to the start of "
        "the step.\n"
        "- `motion.diverged`: energy a hundred times what was there or put in, or a speed that doubles every few steps, on and on. The "
        "motion goes on; its numbers are worth nothing. Energy is counted anew after each request.\n"
        "- `contact.missed`: a body passed through another between two detections. The check follows its centre of mass: a corner that "
        "passes is not noticed.\n"
        "- `contact.deep`: bodies stay sunk into one another, where impulses or rows should hold them.\n\n"
        "Cells: " +
        summary(cases, table) + ".\n\n";
    for (const Case& c : cases) out += section(c, table);
    out.pop_back();
    return out;
}

}  // namespace plab::stability
