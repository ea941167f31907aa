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

/// One line without tabs, as tables keep it, and back.
std::string to_line(const Outcome& outcome);
std::optional<Outcome> from_line(std::string_view line);

/// The same verdict for the same reasons, and figures that differ by less than a factor of ten. Figures below `kRounding` count as
/// rounding, which differs between compilers.
inline constexpr double kRounding = 1e-11;
bool agree(const Outcome& expected, const Outcome& measured);

}  // namespace plab::stability
