/// The command line of plab-study.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "program/command_line.h"
#include "study/settings.h"
#include "study/study.h"

namespace plab::study
{

struct StudyOptions
{
    std::string scene;  ///< or the suite's file
    bool suite = false;
    bool list = false;
    bool list_exact = false;
    bool quiet = false, progress = false;  ///< nothing on standard error; progress lines even if that is not a terminal
    std::vector<Algorithm> algorithms;
    std::vector<std::vector<Setting>> varied;
    ReferencePlan reference;
    std::vector<std::string> quantities;
    std::map<std::string, double> scales;
    std::vector<PlannedSwap> swaps;
    std::optional<double> floor;
    double until = -1;
    double budget = std::numeric_limits<double>::infinity();
    double tolerance = 1e-6;  ///< suite: largest error that counts as solved
    int repeat = 5;
    bool govern = false;         ///< compares a governor with one level for all
    std::string governor;        ///< its id; empty: the first one of the scene
    bool verify_levels = false;  ///< checks what governors promise; `scene` may be a recording
    std::string out;
    std::string command;  ///< the command line as typed
};

/// What to print, and the exit code: 0 after --help and --version, 2 for wrong usage.
using program::ParseEnd;
std::optional<ParseEnd> parse_options(int argc, char** argv, StudyOptions& options);

}  // namespace plab::study
