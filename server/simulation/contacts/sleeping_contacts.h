/// The contact points of islands that sleep, for the contact log: steps do not detect them, so they are detected here, once for each
/// island.
#pragma once

#include <memory>
#include <vector>

#include "simulation/contacts/contact_book.h"
#include "simulation/contacts/sleeping_pairs.h"

namespace plab::simulation
{

class SleepingContacts
{
public:
    SleepingContacts(StepState& step, ContactBook& contacts) : step_(step), contacts_(contacts) {}

    /// At the end of a step that is logged: completes the log.
    void finish_step();
    /// After any structural change.
    void rebuild() { mark_.reset(), known_.clear(), all_.clear(); }

private:
    struct Known
    {
        std::shared_ptr<const SleepingIsland> island;
        std::vector<LoggedContact> contacts;
    };
    void find_in(const SleepingIsland& island, std::vector<LoggedContact>& out);
    void note(const PairState& pair, const Contact& at, std::vector<LoggedContact>& out) const;

    StepState& step_;
    ContactBook& contacts_;
    std::shared_ptr<const char> mark_;  ///< RestState::mark when all_ was made
    std::vector<Known> known_, before_;
    std::vector<LoggedContact> all_;
    std::vector<PersistentPair> persistent_;
    std::vector<FoundContact> found_;
};

}  // namespace plab::simulation
