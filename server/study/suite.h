/// A catalogue of studies, and its overall results: digits by problem and algorithm, and the performance profile.
/// JSON: {"studies": [{"name", "scene", "title", "vary": [..], "algorithms": [..], "reference", "reference_algorithm",
/// "quantities": [..], "until", "floor", "ladder", "scales": {quantity: length}}]}, with the texts of the command line; paths
/// of scenes are relative to the file.
#pragma once

#include "study/study.h"

namespace plab::study
{

struct SuiteEntry
{
    std::string name, title, scene;  ///< scene: path
    std::string ladder;              ///< studies of one ladder are evaluated together; empty: those with the same algorithms
    std::vector<Algorithm> algorithms;
    std::vector<std::vector<Setting>> varied;
    ReferencePlan reference;
    std::vector<std::string> quantities;
    double until = 1;
    std::optional<double> floor;
    std::map<std::string, double> scales;  ///< a of the mixed error, by quantity, if given
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
    const Interruption* stop = nullptr;  ///< asked whether to stop
    std::function<void(const std::string&)> progress;
};

/// The size of each study of the suite, without running it.
struct SuiteLine
{
    const SuiteEntry* entry = nullptr;
    Workload work;
    std::string trouble;  ///< why it cannot be studied; "": it can
};
std::vector<SuiteLine> workload_of(model::TypeSource& types, const Suite& suite, const SuiteOptions& options);

/// Writes each study to a folder of its own below `folder`, and report.html, suite.json, digits and profile to `folder`.
/// Returns the findings, in sentences. A study that fails is listed as such. An interruption is an error, which states how much
/// of the suite was written.
Result<std::vector<std::string>> run_suite(model::TypeSource& types, const Suite& suite, const SuiteOptions& options,
                                           const std::string& folder);

}  // namespace plab::study
