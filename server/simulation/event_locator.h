/// Finds the first contact event inside a step, rewinds whom it touches, lets the response act, and goes on.
///
/// Local scope: only the groups of the pair (and what rests on them) go back; everybody else keeps its end-of-step state,
/// bit for bit. World scope, the paper's: everything goes back. Each group remembers where its present smooth piece began.
#pragma once

#include <vector>

#include "simulation/stepper.h"

namespace plab::simulation
{

class EventLocator
{
public:
    explicit EventLocator(Stepper& stepper) : s_(&stepper) {}
    /// Until the step holds no event any more. Leaves the contacts of the end of the step in `found`.
    void run(std::vector<FoundContact>& found);

private:
    /// A pair that overlaps at the end of the step though it was clear before.
    struct Candidate
    {
        std::uint32_t detector = 0;
        Ref a, b;
        bool located = false;
        bool stuck = false;                  ///< overlaps where the piece begins: there is nothing to bracket
        bool at_end = false;                 ///< no event location: answered where the step ends
        double bracket = 0;                  ///< s between the last clear and the first overlapping trial
        double time = 0;                     ///< s since the start of the step, on the clear side
        std::vector<FoundContact> contacts;  ///< as seen on the overlapping side
    };

    void collect(const std::vector<FoundContact>& found);
    void consider(const std::vector<FoundContact>& found, std::size_t begin, std::size_t end);
    bool acts(const Detector& detector, const PairState* pair, bool approaching) const;
    void locate(Candidate& candidate);
    void bracket(Candidate& candidate, Trial& trial);
    bool overlaps_at(Candidate& candidate, double time);
    void scope_of(const Candidate& candidate, bool local);
    double begin_of_scope() const;
    /// Answers the event. True if someone was rewound for it, so that what was found is stale.
    bool process(Candidate& candidate);
    /// Rewinds the scope and advances it from where its pieces began to `time`.
    void advance_scope(double time, WorkBook book, bool trial);
    void calm(std::vector<FoundContact>& contacts) const;
    void keep_if_it_cannot_leave(Contact& c) const;
    void answer(Candidate& candidate);
    void look_from_the_clear_side(Candidate& candidate);
    void rate_of_approach(std::vector<FoundContact>& contacts, double at);
    void record(Candidate& candidate, const std::vector<FoundContact>& contacts, double time);
    void announce_rest(const FoundContact& f, PairState& pair, double time);
    void look_again(std::vector<FoundContact>& found);
    void close_over_resting_pairs();

    Stepper* s_;
    std::vector<Candidate> candidates_;
    std::vector<std::uint32_t> scope_;  ///< groups that go back, ascending
    std::vector<std::uint8_t> in_scope_;
    std::vector<std::uint8_t> touched_;  ///< groups that the last answer's impulses reached: what is known of them is stale
    std::vector<FoundContact> seen_, impact_, at_end_;
};

}  // namespace plab::simulation
