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
    Degraded,  ///< finite and bounded, but wrong by more than the bound, or with a warning that says so
    Refused,   ///< the scene was not accepted; the message says why
    Diverged,  ///< beyond all bounds, and a named event of the simulation said so
    Silent,    ///< a hang, a crash, or beyond all bounds without a word: a defect
};

struct Outcome
{
    Verdict verdict = Verdict::Silent;
    double figure = 0;  ///< the case's measure of error; its meaning and unit stand in the case's text
    std::string how;    ///< kinds of warnings that were raised, or the refusal
    friend bool operator==(const Outcome&, const Outcome&) = default;
};

/// What an error counts as.
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

/// The same verdict for the same reasons, and figures that differ by less than a factor of ten. What is below
/// `kRounding` counts as rounding, which other compilers do otherwise.
inline constexpr double kRounding = 1e-11;
bool agree(const Outcome& expected, const Outcome& measured);

}  // namespace plab::stability
