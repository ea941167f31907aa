/// Where the time of a step goes. Each thread that steps has one meter. Measured times are exclusive (a nested scope is not counted in
/// the scope around it), so all accounts together add up to the time between start() and stop().
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

#include "plab/stage.h"
#include "simulation/costs/clock.h"

namespace plab::simulation
{

/// Nanoseconds by account. Commands of expensive types are timed for each component; those of cheap types by type, and the rows share the
/// sum.
struct CostAccounts
{
    std::vector<std::int64_t> by_component;
    std::vector<std::int64_t> by_table;
    std::vector<std::uint32_t> phases;  ///< by table: bit mask of the phases that ran; never cleared
    std::int64_t host = 0;              ///< work that belongs to no component: contact caching, mementos, the step loop

    void fit(std::size_t components, std::size_t tables)
    {
        by_component.resize(components, 0);
        by_table.resize(tables, 0), phases.resize(tables, 0);
    }
    void clear();
    CostAccounts& operator+=(const CostAccounts& other);
    std::int64_t sum() const;
};

class CostMeter
{
public:
    CostAccounts& accounts() { return accounts_; }
    const CostAccounts& accounts() const { return accounts_; }

    void start() { depth_ = 0, current_[0] = &accounts_.host, since_ = now(); }
    /// To be called after all scopes have ended.
    void stop() { accounts_.host += now() - since_; }

    /// Books the time from now on to `account`, until leave(). A pair of enter() and leave() costs two clock calls, about 40 ns.
    void enter(std::int64_t& account)
    {
        const std::int64_t at = now();
        *current_[depth_] += at - since_;
        since_ = at;
        assert(depth_ + 1 < kDeepest);
        current_[++depth_] = &account;
    }
    /// `weight`: only one of `weight` calls is measured, and its time counts for all of them. What the unmeasured calls took was booked
    /// to the enclosing account, so it is subtracted there.
    void leave(std::int64_t weight = 1)
    {
        const std::int64_t at = now(), passed = at - since_;
        *current_[depth_] += weight * passed;
        *current_[--depth_] -= (weight - 1) * passed;
        since_ = at;
    }

    std::int64_t& of_component(std::uint32_t i) { return accounts_.by_component[i]; }
    std::int64_t& of_table(std::uint32_t t) { return accounts_.by_table[t]; }
    void ran(std::uint32_t table, Phase phase) { accounts_.phases[table] |= 1u << static_cast<unsigned>(phase); }

private:
    static constexpr std::size_t kDeepest = 32;
    static std::int64_t now() { return static_cast<std::int64_t>(now_ns()); }

    CostAccounts accounts_;
    std::array<std::int64_t*, kDeepest> current_{};
    std::size_t depth_ = 0;
    std::int64_t since_ = 0;
};

/// RAII scope whose time is booked to an account.
class CostScope
{
public:
    CostScope(CostMeter& meter, std::int64_t& account) : meter_(meter) { meter.enter(account); }
    ~CostScope() { meter_.leave(); }
    CostScope(const CostScope&) = delete;
    CostScope& operator=(const CostScope&) = delete;

private:
    CostMeter& meter_;
};

}  // namespace plab::simulation
