/// A case of the comparison: scenes, what is sampled, and figures of error that know nothing of engines.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/peers/engine.h"
#include "bench/peers/scene.h"

namespace plab::peers
{

/// Sampled states, time by time.
struct Trace
{
    std::size_t bodies = 0;
    std::vector<double> time;       ///< s
    std::vector<BodyState> states;  ///< bodies x times

    std::size_t size() const { return time.size(); }
    std::span<const BodyState> at(std::size_t i) const { return {states.data() + i * bodies, bodies}; }
    std::span<const BodyState> last() const { return at(size() - 1); }
};

enum class Sampling
{
    EveryStep,
    Rate30,  ///< at 30 Hz, or each step where steps are longer
    Rate60,
    End,
};

struct Metric
{
    std::string name;  ///< of the column in the results
    std::string unit;  ///< "1": relative
    std::string text;  ///< for axes and tables
};

struct Case
{
    std::string id;             ///< "a", "d-elastic"
    std::string title;          ///< for plots
    std::vector<Scene> scenes;  ///< of several, each figure is the worst, and the cost is the mean
    Sampling sampling = Sampling::Rate60;
    std::vector<Metric> metrics;
    /// A figure per metric; not finite if the run failed in this respect.
    std::function<std::vector<double>(const Scene&, const Trace&)> measure;
    std::vector<Step> ladder;  ///< the peers' steps
    double cpu_limit = 60;     ///< s of processor time per run
};

/// All cases, a to i, or those whose ids begin with one of `wanted` (all if it is empty).
std::vector<Case> make_cases(const std::vector<std::string>& wanted);

// The parts that make_cases puts together.
void add_motion_cases(std::vector<Case>& out);   // a, b, c
void add_contact_cases(std::vector<Case>& out);  // d, e, f
void add_joint_cases(std::vector<Case>& out);    // g, h, i

/// Steps 1/n of the given n.
std::vector<Step> steps(std::initializer_list<int> per_second);

/// Kinetic and potential energy, J; the latter is 0 at z = 0.
double energy_of(const Scene& scene, std::span<const BodyState> states);

}  // namespace plab::peers
