/// What became of one extreme case with one algorithm of a ladder: measured, never declared.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace plab::stability
{

enum class Verdict : std::uint8_t
{
    Stable,    ///< within the case's bound, and nothing to report
    Degraded,  ///< finite and bounded, but wrong by more than the bound, or with a warning about it
    Refused,   ///< the scene was not accepted; the message says why
    Diverged,  ///< beyond all bounds, and reported by a named event of the simulation
    Silent,    ///< a hang, a crash, or beyond all bounds without a report: a defect
};

struct Outcome
{
    Verdict verdict = Verdict::Silent;
    double figure = 0;  ///< the case's measure of error; its meaning and unit are in the case's text
    std::string how;    ///< kinds of warnings that were raised, or the refusal
    /// Share of the time that was simulated until the budget of force evaluations was used up, %; nothing: all of it.
    std::optional<double> reached;
    friend bool operator==(const Outcome&, const Outcome&) = default;
};

/// The classification of an error.
struct Bounds
{
    double stable = 0;   ///< up to here: stable
    double bounded = 0;  ///< up to here: degraded; beyond: diverged
};

std::string_view name_of(Verdict verdict);
std::optional<Verdict> verdict_of(std::string_view name);

/// `how`, and how far a cell came that was too slow.
std::string reason_of(const Outcome& outcome);
/// One line without tabs, as tables keep it, and back.
std::string to_line(const Outcome& outcome);
std::optional<Outcome> from_line(std::string_view line);

/// The same verdict for the same reasons, and figures that differ by less than a factor of ten. Figures below `kRounding` count as
/// rounding, which differs between compilers. How far a slow cell came may differ by `kPace`, and by the rounding of the text: where
/// errors choose the internal steps or Newton's method fails, their number depends on the last digits. A mass that differs by a unit in
/// the last place takes the chain with a link of 1e6 kg under ImplicitMidpoint to 62 % or to 84 % of the time.
inline constexpr double kRounding = 1e-11, kPace = 1.5;
bool agree(const Outcome& expected, const Outcome& measured);

}  // namespace plab::stability
