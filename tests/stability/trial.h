/// A scene that may fail: its events are collected, and its work is bounded.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "outcome.h"
#include "simulation/simulation.h"

namespace plab::stability
{

/// Force evaluations that one cell may take, beside the limit of CPU time that ends its process: they are the same on every
/// machine, time is not.
inline constexpr std::uint64_t kMostEvaluations = 100'000, kManyEvaluations = 1'000'000;

class Trial
{
public:
    /// `body` is the content of <plab>, `settings` the scene's attributes.
    Trial(const std::string& body, const std::string& settings, std::uint64_t most_evaluations = kMostEvaluations);

    bool loaded() const { return simulation_ != nullptr; }
    const std::string& refusal() const { return refusal_; }
    simulation::Simulation& simulation() { return *simulation_; }

    /// Steps to `until` or until the budget is used up; `watch()` checks after each step.
    template <class Watch>
    void run(double until, Watch&& watch)
    {
        if (!loaded()) return;
        until_ = until;
        const double half = simulation_->dt() / 2;
        while (simulation_->time() < until - half && evaluations_ < most_evaluations_)
        {
            step();
            watch();
        }
        finished_ = simulation_->time() >= until - half;
    }
    void run(double until)
    {
        run(until, [] {});
    }

    double real(const std::string& id, const std::string& field) const;
    Vec3 vec(const std::string& id, const std::string& field) const;
    Quat quat(const std::string& id, const std::string& field) const;
    /// How often an event of this kind was raised, of whatever severity.
    std::size_t count(const std::string& kind) const;
    /// Whether events other than information were raised.
    bool warned() const { return !troubles_.empty(); }

    /// The verdict on an error. A value that is not finite, or beyond the bounds, must have been reported.
    Outcome judge(double error, Bounds bounds) const;

private:
    void step();
    Outcome outcome(Verdict verdict, double error) const;

    std::unique_ptr<simulation::Simulation> simulation_;
    std::string refusal_;
    std::map<std::string, std::size_t> counts_, troubles_;
    std::uint64_t most_evaluations_, evaluations_ = 0;
    double until_ = 0;
    bool finished_ = true;
};

/// Names of all types of a family, in order: a new algorithm appears by itself.
std::vector<std::string> algorithms_of(const std::string& family);
/// Loads every plugin, so that cells in processes of their own need not.
void load_plugins();

}  // namespace plab::stability
