/// Persistent contacts that impulses hold, solved by managers (held_islands.h) or by responses (impulse_islands.h). At the end of a step
/// this class also decides which known pairs persist and which end.
#pragma once

#include "simulation/contacts/force_parts.h"
#include "simulation/contacts/held_islands.h"
#include "simulation/contacts/impulse_islands.h"
#include "simulation/contacts/sleeping_islands.h"
#include "simulation/contacts/turn_parts.h"

namespace plab::simulation
{

class HardContacts
{
public:
    HardContacts(StepState& step, GroupMotion& motion, ContactBook& contacts)
        : step_(step),
          motion_(motion),
          contacts_(contacts),
          positions_(step, motion, contacts),
          held_(step, motion, contacts),
          impulses_(step, motion, contacts, positions_),
          sleeping_(step, motion, contacts),
          parts_(step, motion),
          turns_(step, contacts)
    {
    }

    /// After any structural change.
    void rebuild() { held_.rebuild(), sleeping_.rebuild(), parts_.rebuild(); }
    void begin_step();
    /// A script may have changed what the rest of bodies depends on.
    void note_change() { sleeping_.note_change(); }
    /// Whether the detectors have looked at all bodies where these are now. False if that is not known.
    bool has_looked_at_all() const;
    /// Whether all detectors look at the bodies of a step once, where these are at its start.
    bool looks_once() const;
    /// Whether islands sleep; then only these groups have to be advanced.
    bool any_asleep() const { return sleeping_.any(); }
    const std::vector<std::uint32_t>& awake_groups() const { return sleeping_.awake_groups(); }
    /// Whether groups have to advance as islands because of a persistent contact, or of a joint that only a manager can hold.
    bool needs_islands() const;
    /// Whether a group has such a joint in this step.
    bool holds_joints_of(std::uint32_t group) const { return held_.holds_joints_of(group); }
    /// Advances groups with persistent contacts from their present state, each island by itself, in parts where forces ask for that
    /// (force_parts.h). Times in s since the start of the step.
    void advance(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed, double from, double to, WorkBook book,
                 bool trial);
    /// With the contacts of the end of the step in ContactBook::found(): decides which pairs begin, persist and end, and corrects
    /// positions.
    void finish_step();

private:
    bool ends(PairState& pair, std::span<FoundContact> own, double time);
    void list_passed();
    static bool keeps_features(const PairState& pair, std::span<FoundContact> found);
    void update_features(PairState& pair, std::span<FoundContact> found);
    void join_islands(std::span<const std::uint32_t> groups);
    void advance_at_once(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed, double from, double to,
                         WorkBook book, bool trial, bool begins);
    void advance_in_parts(std::span<const std::uint32_t> observed, double from, double to, WorkBook book, bool trial);
    void list_divided(std::span<const std::uint32_t> groups);
    void list_kinematic(std::uint32_t island);
    std::size_t list_islands();

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    PositionCorrection positions_;
    HeldIslands held_;
    ImpulseIslands impulses_;
    SleepingIslands sleeping_;
    ForceParts parts_;
    TurnParts turns_;
    DisjointSets islands_;               ///< of groups; single sets but for those in reached_
    IndexSet reached_;                   ///< groups that hold together with those of the present advance
    std::vector<std::uint32_t> places_;  ///< of the pairs between them
    std::vector<std::uint32_t> groups_;
    std::vector<std::size_t> passed_;                  ///< places of pairs, ascending
    std::vector<std::uint32_t> number_;                ///< by representative group: of its island in the present advance
    std::vector<std::vector<std::uint32_t>> members_;  ///< groups, by island; lists keep their memory
    struct Divided
    {
        std::uint32_t island = 0, group = 0;  ///< island: representative group
        friend auto operator<=>(const Divided&, const Divided&) = default;
    };
    std::vector<Divided> divided_;             ///< of islands that advance in parts
    std::vector<std::uint32_t> whole_;         ///< groups of all others
    std::vector<std::uint32_t> part_members_;  ///< groups of the island that advances in parts
    std::vector<std::uint32_t> kinematic_;     ///< groups of kinematic bodies that touch it
    std::vector<std::uint32_t> parts_of_;      ///< by representative group; 0 but while groups are distributed
};

}  // namespace plab::simulation
