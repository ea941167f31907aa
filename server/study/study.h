/// A study: every combination of a plan, its errors against a reference, its cost.
#pragma once

#include <functional>

#include "study/reference.h"
#include "study/settings.h"
#include "study/swaps.h"

namespace plab::study
{

struct ReferencePlan
{
    enum class Kind : std::uint8_t
    {
        None,
        Auto,
        Exact,
        File,
    };
    Kind kind = Kind::Auto;
    std::string text;                    ///< name of the closed form, or path
    std::optional<Algorithm> algorithm;  ///< auto: this one; otherwise the finest algorithm of the plan
};
/// "auto", "none", "exact:NAME", or a path.
ReferencePlan parse_reference(const std::string& text);

struct Plan
{
    model::SceneSpec scene;
    std::string title;
    std::string command;  ///< command line to repeat the study
    std::vector<Combination> combinations;
    ReferencePlan reference;
    RunOptions run;                        ///< without sample times and swaps, which follow from the step lengths
    std::vector<PlannedSwap> swaps;        ///< in every run, and in those of the reference `auto`
    int repeat = 3;                        ///< timed runs of each combination
    std::map<std::string, double> scales;  ///< a of the mixed error, by quantity, if given
    std::function<void(const std::string&)> progress;
};

/// Contacts of a run compared with those of the reference.
struct ContactFigures
{
    bool known = false;
    int expected = 0, missed = 0, extra = 0;
    double worst_time_error = 0;  ///< s, of the matched ones
};

/// A data point.
struct Point
{
    Combination combination;
    RunRecord record;
    std::vector<Distance> errors;  ///< by quantity
    std::vector<bool> resolved;    ///< false: the error is within the reference's uncertainty
    ContactFigures contacts;
    double energy_drift = 0;             ///< largest |drift| / energy scale, 1
    double cpu_min = 0, cpu_median = 0;  ///< s for the whole run; NaN: not timed
    int timed = 0;

    /// Largest over the quantities.
    double error() const;
    double final_error() const;
    bool is_resolved() const;
    double simulated() const { return record.reached; }
    double cpu_per_second() const { return cpu_min / record.reached; }
    double cpu_per_step() const { return cpu_min / static_cast<double>(record.steps); }
};

struct Machine
{
    std::string processor, system, compiler, flags, version;
};
Machine describe_machine();

struct StudyResult
{
    std::string title, scene_file, command;
    double until = 0;  ///< s, last common instant
    int repeat = 0;
    Machine machine;
    Reference reference;
    std::vector<Quantity> quantities;
    std::vector<Point> points;
    std::vector<std::string> notes;  ///< notes for the reader on how the study was made
    bool swaps = false;
};

/// The size of a plan, before it is run.
struct Workload
{
    std::size_t cells = 0, refused = 0;  ///< combinations, and those whose scene or setting is not possible
    double seconds = 0;                  ///< CPU time, from the first steps of each: correct within a factor of a few
};
Workload workload_of(model::TypeSource& types, const Plan& plan);

/// Checks the swaps: their steps or times in all runs; id and type in at least one. Runs nothing.
Result<void> check_swaps(model::TypeSource& types, const Plan& plan);

/// Runs the whole plan. Fails only if nothing could be studied: no combination, no common instants, unknown quantity or closed
/// form, swaps that are not possible.
Result<StudyResult> run_study(model::TypeSource& types, const Plan& plan);

/// Matches contacts of the same pair by the alignment in time with the lowest cost.
ContactFigures compare_contacts(const std::vector<RecordedContact>& run, const std::vector<RecordedContact>& reference);

/// -log10 of an error, from 0 to 16; NaN stays.
double digits(double error);

}  // namespace plab::study
