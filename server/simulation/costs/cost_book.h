/// Statistics of the cost of steps: sums since the scene was built, and a window of the latest steps for medians and their spread.
#pragma once

#include <memory>

#include "simulation/costs/cost_meter.h"
#include "simulation/costs/spread.h"

namespace plab::simulation
{

/// A ring buffer with the latest costs of one account, ns per step.
class CostWindow
{
public:
    void push(double ns)
    {
        ns_[next_] = static_cast<float>(ns);
        next_ = (next_ + 1) % kLength;
        count_ = count_ < kLength ? count_ + 1 : kLength;
    }
    void clear() { next_ = count_ = 0; }
    Spread spread() const;

private:
    static constexpr std::uint32_t kLength = 64;
    std::array<float, kLength> ns_{};
    std::uint32_t next_ = 0, count_ = 0;
};

class CostBook
{
public:
    /// To be called after a structural change. `owners`: by component, the table if the component is timed on its own, else kNoIndex. A
    /// component that is new, or that has changed its type, starts with empty statistics.
    void rebuild(std::span<const std::uint32_t> owners, std::size_t tables);
    /// The component was removed; a new component that reuses its index starts with empty statistics.
    void forget(std::uint32_t component)
    {
        if (component < own_.size()) own_[component].reset();
    }
    /// To be called at the end of a step: adds the accounts to the statistics and clears them.
    void book(CostAccounts& accounts);

    std::uint64_t steps() const { return steps_; }  ///< number of booked steps
    /// Mean since the scene was built, ns per step: of the whole step (all threads), and of the work that belongs to no component.
    double mean() const { return mean_of(total_); }
    double mean_of_host() const { return mean_of(host_total_); }
    double mean_of_component(std::uint32_t i) const { return owns(i) ? mean_of(own_[i]->total) : 0.0; }
    double mean_of_table(std::uint32_t t) const { return t < tables_.size() ? mean_of(tables_[t].total) : 0.0; }
    /// Median and spread over the latest steps.
    Spread step() const { return step_.spread(); }
    Spread host() const { return host_.spread(); }
    Spread of_component(std::uint32_t i) const { return owns(i) ? own_[i]->window.spread() : Spread{}; }
    Spread of_table(std::uint32_t t) const { return t < tables_.size() ? tables_[t].window.spread() : Spread{}; }
    bool owns(std::uint32_t i) const { return i < own_.size() && own_[i]; }

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    struct Account
    {
        std::uint32_t table = kNone;
        double total = 0;
        CostWindow window;
    };
    double mean_of(double total) const { return steps_ == 0 ? 0.0 : total / static_cast<double>(steps_); }

    std::vector<std::unique_ptr<Account>> own_;  ///< by component; null: not timed on its own, as most are
    std::vector<Account> tables_;
    std::vector<std::uint32_t> owners_;
    CostWindow step_, host_;
    double total_ = 0, host_total_ = 0;
    std::uint64_t steps_ = 0;
};

}  // namespace plab::simulation
