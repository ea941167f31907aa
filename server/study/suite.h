/// A catalogue of studies, and what they say together: digits by problem and algorithm, and the performance profile.
///
/// JSON: {"studies": [{"name", "scene", "title", "vary": [..], "algorithms": [..], "reference", "reference_algorithm", "quantities": [..],
/// "until", "floor", "ladder", "scales": {quantity: length}}]}, with the words of the command line; scenes are found beside the file.
#pragma once

#include "study/study.h"

namespace plab::study
{

struct SuiteEntry
{
    std::string name, title, scene;  ///< scene: path
    std::string ladder;              ///< studies of one ladder are looked at together; empty: those with the same algorithms
    std::vector<Algorithm> algorithms;
    std::vector<std::vector<Setting>> varied;
    ReferencePlan reference;
    std::vector<std::string> quantities;
    double until = 1;
    std::optional<double> floor;
    std::map<std::string, double> scales;  ///< a of the mixed error, by quantity, where it is given
};
struct Suite
{
    std::string file, title;
    std::vector<SuiteEntry> entries;
};
Result<Suite> read_suite(const std::string& path);

struct SuiteOptions
{
    int repeat = 3;
    double budget = std::numeric_limits<double>::infinity();
    double tolerance = 1e-6;
    std::string command;
    std::uint64_t (*allocations)() = nullptr;
    const Interruption* stop = nullptr;  ///< asked: nobody wants the rest
    std::function<void(const std::string&)> progress;
};

/// What each study of the suite comes to, without running it.
struct SuiteLine
{
    const SuiteEntry* entry = nullptr;
    Workload work;
    std::string trouble;  ///< why it cannot be studied; "": it can
};
std::vector<SuiteLine> workload_of(model::TypeSource& types, const Suite& suite, const SuiteOptions& options);

/// Each study in a folder of its own below `folder`, and report.html, suite.json, digits and profile in `folder`. The
/// findings, in sentences. A study that cannot be made is listed as such. One that is interrupted is an error, which says what of
/// the suite is there.
Result<std::vector<std::string>> run_suite(model::TypeSource& types, const Suite& suite, const SuiteOptions& options,
                                           const std::string& folder);

}  // namespace plab::study
