// The rows of joints, limits, motors and forces in the sub-steps of SoftStep.
#include <algorithm>
#include <cmath>

#include "soft_island.h"

namespace plab::managers
{
namespace
{

/// Whether position correction pulls at the row: a joint that is apart, or a limit that is passed.
bool is_pulled(const ConstraintRow& row) { return row.kind == RowKind::Equality || (row.kind == RowKind::OneSided && row.error < 0); }

}  // namespace

template <int W>
void SoftIsland<W>::sweep_lines(bool soft, std::size_t first)
{
    bound_resistances();
    for (std::size_t i = first; i < problem_.lines.size(); ++i)
    {
        Line& line = problem_.lines[i];
        if (line.count == 0) continue;
        const ConstraintRow& row = problem_.row_of(line);
        const bool pulled = soft && is_pulled(row);
        const double bias = pulled ? sweep_.between.bias_rate * row.error : 0.0, before = line.impulse;
        const double share = pulled ? sweep_.between.mass_scale : 1.0, leak = pulled ? sweep_.between.impulse_scale : 0.0;
        line.impulse = std::clamp(before - share * (problem_.gap(line) + bias) / line.admittance() - leak * before, line.least, line.most);
        problem_.push(line, line.impulse - before);
        memory_.line_greatest[i] = std::max(memory_.line_greatest[i], line.impulse);
    }
}

template <int W>
void SoftIsland<W>::bound_resistances()
{
    (void)problem_.bound_resistances([this](std::uint32_t i) { return contacts_.impulse(i).z; });
}

/// One sweep over the rows is far from enough for joints under load and for forces that change within the step. So all rows are held
/// exactly, with the contacts as they are, but for those of large nets without such forces.
template <int W>
bool SoftIsland<W>::holds_rows()
{
    if (std::ranges::none_of(problem_.lines, [](const Line& line) { return line.count > 0 && !line.resists(); })) return false;
    memory_.step.joints.load(problem_);
    return memory_.step.joints.is_cheap(problem_) || std::ranges::any_of(island_.rows, [](const ConstraintRow& row) { return row.kind == RowKind::ForceChange; });
}

/// `corrects`: joints that are apart, and limits that are passed, close as fast as contacts that overlap. `anew`: rows are others than at
/// the last call.
template <int W>
void SoftIsland<W>::hold_rows(bool corrects, bool anew)
{
    if (!holds_) return;
    const auto close_at = [&](double speed_per_error)
    {
        for (Line& line : problem_.lines)
            if (const ConstraintRow& row = problem_.row_of(line); is_pulled(row)) line.target -= speed_per_error * row.error;
    };
    const double tolerance = 1e-3 * choices_.tolerance;
    if (corrects) close_at(sweep_.between.bias_rate);
    if (anew)
        memory_.step.joints.hold(problem_, tolerance);
    else
        memory_.step.joints.hold_again(problem_, tolerance);
    if (corrects) close_at(-sweep_.between.bias_rate);
    for (std::size_t i = 0; i < problem_.lines.size(); ++i)
        memory_.line_greatest[i] = std::max(memory_.line_greatest[i], problem_.lines[i].impulse);
    if (problem_.has_resistances()) sweep_lines(false, problem_.row_count());
}

template void SoftIsland<1>::bound_resistances();
template void SoftIsland<4>::bound_resistances();
template bool SoftIsland<1>::holds_rows();
template bool SoftIsland<4>::holds_rows();
template void SoftIsland<1>::hold_rows(bool, bool);
template void SoftIsland<4>::hold_rows(bool, bool);
template void SoftIsland<1>::sweep_lines(bool, std::size_t);
template void SoftIsland<4>::sweep_lines(bool, std::size_t);

}  // namespace plab::managers
