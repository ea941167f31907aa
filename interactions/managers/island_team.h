/// The islands of a call, divided among the threads that the host lends: small ones advance side by side, each on one thread, and in large
/// ones all threads share the loops (plab/shares.h, plab/parts.h). Both ways give the same bits.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <memory>
#include <span>
#include <vector>

#include "plab/island.h"
#include "plab/shares.h"

namespace plab::managers
{

/// What the working memory of an island has to hold.
struct IslandSize
{
    std::size_t points = 0, movers = 0;
    std::size_t bodies = 0, shafts = 0;  ///< rows of the host's tables
};

/// `Memory` has reserve(IslandSize). What it holds between two islands must not show in results.
template <class Memory>
class IslandTeam
{
public:
    IslandTeam() = default;
    IslandTeam(const IslandTeam&) {}
    IslandTeam& operator=(const IslandTeam&) { return *this; }

    /// Calls solve(number, memory) once for each island, in memory that no other thread uses meanwhile. `host`: numbers of rows;
    /// divides(number): whether threads can share the loops of that island.
    template <class Divides, class Solve>
    void advance(std::span<const Island> islands, const IslandSize& host, Workers* workers, const Divides& divides, const Solve& solve);
    /// Forgets what the memories hold.
    void clear() { slots_.clear(); }

private:
    struct Slot
    {
        std::atomic<bool> taken{false};
        Memory memory;
    };
    void make_room(std::span<const Island> islands, IslandSize most, std::size_t threads);
    Slot& take_slot();

    std::vector<std::unique_ptr<Slot>> slots_;  ///< one for each thread
    Shares shares_;
};

/// Makes room for the largest island in each memory if several threads may take it: which one does so differs from step to step, and a warm
/// step must not allocate.
template <class Memory>
void IslandTeam<Memory>::make_room(std::span<const Island> islands, IslandSize most, std::size_t threads)
{
    while (slots_.size() < threads) slots_.push_back(std::make_unique<Slot>());
    if (threads < 2 || islands.size() < 2) return;
    for (const Island& i : islands)
    {
        most.points = std::max(most.points, std::bit_ceil(i.contacts.size()));
        most.movers = std::max(most.movers, std::bit_ceil(i.bodies.size() + i.shafts.size()));
    }
    for (const auto& slot : slots_) slot->memory.reserve(most);
}

template <class Memory>
typename IslandTeam<Memory>::Slot& IslandTeam<Memory>::take_slot()
{
    for (std::size_t i = 0;; i = (i + 1) % slots_.size())
        if (!slots_[i]->taken.exchange(true, std::memory_order_acquire)) return *slots_[i];
}

template <class Memory>
template <class Divides, class Solve>
void IslandTeam<Memory>::advance(std::span<const Island> islands, const IslandSize& host, Workers* workers, const Divides& divides,
                                 const Solve& solve)
{
    constexpr std::size_t kWorth = 256;  // contact points
    make_room(islands, host, workers ? static_cast<std::size_t>(workers->threads()) : 1);
    shares_.run(
        workers, islands.size(), kWorth, [&](std::size_t i) { return islands[i].contacts.size(); }, divides,
        [&](std::size_t i)
        {
            Slot& mine = take_slot();
            solve(i, mine.memory);
            mine.taken.store(false, std::memory_order_release);
        });
}

}  // namespace plab::managers
