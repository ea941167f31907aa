/// The options of a run, and its results.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "plab/interruption.h"
#include "simulation/simulation.h"
#include "study/quantity.h"

namespace plab::study
{

/// A swap inside a run: before step `at`.
struct SwapAt
{
    Tick at = 0;
    std::string id, type;
};

struct RunOptions
{
    double until = 1;                     ///< s, simulated
    std::vector<double> sample_times;     ///< s, increasing, at step boundaries; empty: about 200, evenly
    std::vector<std::string> quantities;  ///< "ball.position"
    std::vector<SwapAt> swaps;
    std::optional<double> floor;  ///< m: a dynamic body whose centre of mass gets below this z has fallen through
    double budget = std::numeric_limits<double>::infinity();  ///< s of CPU time for the steps of one run
    std::uint64_t (*allocations)() = nullptr;                 ///< number of calls of operator new so far, if the program counts them
    const Interruption* stop = nullptr;                       ///< asked whether to stop, also during a step

    bool is_stopped() const { return stop != nullptr && stop->asked(); }
};

enum class Outcome : std::uint8_t
{
    Completed,
    Refused,      ///< the scene did not load, or a quantity does not exist
    NotFinite,    ///< an object's state, or the energy, was no longer a number
    BlewUp,       ///< the event motion.diverged, or an error of more than a thousand times the reference's motion
    Quarantined,  ///< a component failed
    FellThrough,  ///< a body got below the floor
    TooSlow,      ///< stopped when the budget was used up
    Frozen,       ///< steps had no effect: the run was paused
    SwapRefused,  ///< a swap was refused, or its step never came
    Interrupted,  ///< RunOptions::stop: no result
};
std::string_view name_of(Outcome outcome);

/// Mechanical totals at the sample times.
struct EnergySeries
{
    std::vector<double> time;    ///< s
    std::vector<double> energy;  ///< kinetic and stored, J
    std::vector<double> drift;   ///< unexplained energy: unexplained_energy() since the start, J
    double scale = 0;            ///< largest kinetic or change of stored energy, J
};

/// A contact that began, in order of time.
struct RecordedContact
{
    std::string kind;  ///< "contact.begin" or "contact.impact"
    std::string a, b;
    double time = 0;  ///< s
};

/// The algorithm that does the work of one component, and what it reported.
struct PartFigures
{
    std::string id, requested;
    std::string resolved;                   ///< its output `resolved` if it has one, otherwise the host's description
    double error = 0;                       ///< largest output that is declared as an error, over the samples
    std::map<std::string, double> outputs;  ///< numeric outputs at the end
    std::map<std::string, double> largest;  ///< whole-number outputs (iterations, sub-steps): largest over the samples
};

struct RunRecord
{
    Outcome outcome = Outcome::Completed;
    std::string why;  ///< in words, unless completed

    double dt = 0;       ///< s
    Tick steps = 0;      ///< made
    double reached = 0;  ///< s
    std::uint64_t hash = 0;

    std::vector<double> times;  ///< s, of the samples that were reached
    std::vector<Quantity> quantities;
    std::vector<TimeSeries> time_series;  ///< by quantity
    EnergySeries energy;
    double momentum_change = 0;                             ///< N s, largest |P - P at start|
    double angular_momentum_change = 0;                     ///< N m s, about the world's origin
    double shaft_momentum_change = 0;                       ///< N m s
    double momentum_scale = 0, angular_momentum_scale = 0;  ///< largest magnitudes

    double violation = 0;    ///< largest declared error of a constraint, in its own unit
    double penetration = 0;  ///< m, largest penetration left at the end of a step
    double residual = 0;     ///< m/s, left over by contact responses
    std::vector<RecordedContact> contacts;
    bool contacts_cut = false;            ///< there were more than are kept
    std::map<std::string, int> warnings;  ///< events of severity warning and failure, by kind
    std::map<std::string, int> events;    ///< all events, by kind
    std::string first_warning;            ///< in words
    std::uint64_t trials = 0, rewinds = 0;
    std::uint64_t evaluations = 0;             ///< of forces, trials included
    std::optional<std::uint64_t> allocations;  ///< in warm steps; empty: there was no such step
    std::vector<PartFigures> parts;            ///< solvers, managers, responses, resolutions, constraints
    std::vector<simulation::Reply> swaps;

    bool ok() const { return outcome == Outcome::Completed; }
};

struct Timing
{
    Outcome outcome = Outcome::Completed;
    double cpu = 0;  ///< s of this thread, step loop only
    Tick steps = 0;
    double reached = 0;  ///< s, simulated
};

}  // namespace plab::study
