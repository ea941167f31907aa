/// Extreme values of every numeric field of every type, each in a small scene that uses it.
///
/// A value is refused with a message, or the scene steps: each step ends within a bound of processor time, and all states stay
/// finite; what is not finite among outputs has an event of severity Warning or Failure beside it.
#pragma once

#include <string>
#include <vector>

#include "subjects.h"

namespace plab::test
{

/// A field of the subject and the text that it is given.
struct Extreme
{
    std::string field, text;
};

/// A scene of one type with one or more of its fields at extremes.
struct ExtremeCase
{
    const Subject* subject = nullptr;
    std::vector<Extreme> values;

    std::string name() const;
};

/// Each field alone at each of its extremes: the ends of its rules and beyond, 0, denormal, 1e-300 to 1e308, and negatives.
std::vector<ExtremeCase> single_extremes(const Subject& subject);
/// Two fields at a time, each at a few extremes.
std::vector<ExtremeCase> paired_extremes(const Subject& subject);

/// Runs all in child processes, so that one that crashes or never ends is named and the others still run. What went wrong, a
/// sentence each.
std::vector<std::string> run_extremes(const std::vector<ExtremeCase>& cases, int steps);

}  // namespace plab::test
