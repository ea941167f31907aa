/// The bodies and shapes of one CDetection/ODE, prepared for the broad and the narrow phase.
#pragma once

#include <string>
#include <vector>

#include "broad.h"
#include "narrow.h"
#include "part_seams.h"
#include "plab/collision.h"
#include "plab/collision_filter.h"
#include "plab/context.h"

namespace plab::detection
{

/// The data of one component. It is derived from bodies and shapes alone, so it is not part of a snapshot; it is rebuilt
/// whenever they differ from what it was built from.
class OdeScene
{
public:
    /// Brings parts and poses up to date; returns whether a rebuild was necessary. A context that advances only some bodies must
    /// follow a full detection pass, since when only the poses of bodies that were advanced have changed.
    bool update(const StepContext& context, const std::string& space, const RefList& between, const RefList& against, const Bodies& bodies,
                const Shapes& shapes, const ContactSink& order);
    /// Reports the contacts of all pairs with at least one body that `context` advances, persistent pairs first. If the sink has
    /// motion margins, reports the pairs that may collide within the step instead.
    void detect(const StepContext& context, const Bodies& bodies, const CollisionFilter& filter, ContactSink& sink);
    /// The distance of the two bodies of the query at their present poses: the minimum over all pairs of their shapes; infinite
    /// if none of these collide. Uses the scene of the last update(); only poses may have changed since.
    void measure(GapQuery& query, const Bodies& bodies, const CollisionFilter& filter) const;

    std::size_t pairs() const { return pairs_; }
    double penetration() const { return penetration_; }  ///< m, deepest overlap in the last detection pass
    const std::vector<Collider>& colliders() const { return colliders_; }
    const std::vector<std::uint32_t>& shapes() const { return shape_of_collider_; }
    /// Bodies with a shape, by role, and bodies of both that can move.
    struct Participants
    {
        std::size_t between = 0, against = 0, dynamic = 0;
        bool any_pair() const { return between > 0 && between + against > 1; }
    };
    Participants participants() const;
    /// Bodies that do not move and the first of their shapes whose hull covers hollows of the mesh; without those of the last call.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> fresh_filled_hollows();

private:
    struct Member  // a body that takes part
    {
        std::uint32_t body = 0;
        Membership membership;
        std::uint32_t first_part = 0, end_part = 0;
        std::uint32_t first_shape = 0, end_shape = 0;  // in body_shapes_
        Vec3 position;                                 // pose at the last update
        Quat orientation;
    };
    struct Part  // a shape on a body, or a part of a compound
    {
        std::uint32_t member = 0;
        std::uint32_t collider = 0;
        std::uint32_t shape = 0;  // of the body: for a part of a compound, the compound
        Pose in_body;             // X_BS
        bool turned = false;      // in the body
    };
    struct PersistentQuery
    {
        std::uint32_t a = 0, b = 0;  // members
        Vec3 shift;
    };

    bool is_current(const std::string& space, const RefList& between, const RefList& against, const Bodies& bodies, const Shapes& shapes,
                    const ContactSink& order) const;
    void rebuild(const Bodies& bodies, const Shapes& shapes, const ContactSink& order);
    void add_members(const RefList& bodies, bool between, const Bodies& table);
    void add_colliders(const Bodies& bodies, const Shapes& shapes);
    void add_part(std::uint32_t member, std::uint32_t own, std::uint32_t shape, const Pose& X_BP);
    void move_parts(const Bodies& bodies, bool all, Workers* workers);
    void list_active(const StepContext& context, const RefList& between, const RefList& against);
    void move_member(Member& member, const Bodies& bodies);
    bool may_meet(const Member& a, const Member& b, const StepContext& context) const;
    bool is_excluded(const Part& a, const Part& b, const CollisionFilter& filter) const;
    void report_near(const StepContext& context, ContactSink& sink);
    void collect_persistent(const StepContext& context, const ContactSink& sink);
    bool is_persistent(std::uint32_t a, std::uint32_t b) const;
    Pose place(const Part& part, const Vec3& p_OC, const Bodies& bodies) const;
    /// A contact of two members.
    struct MemberContact
    {
        std::uint32_t a = 0, b = 0;  // members
        ContactPoint at;
    };
    /// What one thread needs for the narrow phase of some pairs, and what it finds.
    struct Narrow
    {
        ContactPoints contact_points;
        std::vector<MemberContact> found;
        std::vector<PartContact> part_contacts;  // of the present pair of members
        std::size_t first = 0;                   // in `found`: where the present pair of members begins
        std::size_t parts_met = 0;               // shape pairs of the present pair of members
        std::size_t pairs = 0;                   // shape pairs with boxes that overlap
        double further_pairs = 0;                // for ContactSink::took
        double penetration = 0;                  // m

        void clear() { found.clear(), part_contacts.clear(), first = 0, parts_met = 0, pairs = 0, further_pairs = 0, penetration = 0; }
    };
    void query(std::uint32_t part_a, std::uint32_t part_b, const Vec3& shift, const Bodies& bodies, Narrow& narrow) const;
    void query_persistent(const Bodies& bodies, ContactSink& sink);
    std::span<const BroadPhase::Pair> candidates(const StepContext& context);
    void query_near(const StepContext& context, const Bodies& bodies, ContactSink& sink);
    std::pair<std::uint32_t, std::uint32_t> members_of(const BroadPhase::Pair& pair) const
    {
        return {parts_[pair.first].member, parts_[pair.second].member};
    }
    void query_chunk(std::size_t chunk, const StepContext& context, const Bodies& bodies, Narrow& narrow) const;
    void finish_pair(double shift, Narrow& narrow) const;
    void deliver(const Narrow& narrow, ContactSink& sink);

    // What the scene was built from.
    std::string space_;
    RefList between_, against_;
    std::vector<std::uint32_t> body_shapes_;        // by member
    std::vector<std::uint32_t> shape_of_collider_;  // sorted

    std::vector<Member> members_;  // in the order of ids
    std::vector<Part> parts_;      // by member, then in the order of the body's shapes, then of a compound's parts
    std::vector<Collider> colliders_;
    BroadPhase broad_;

    // Scratch data of one detection pass.
    const CollisionFilter* filter_ = nullptr;
    std::vector<std::uint32_t> member_of_body_;
    std::vector<PersistentQuery> persistent_;
    std::vector<Narrow> narrow_;  // by chunk; the first serves a pass without threads
    std::span<const BroadPhase::Pair> candidates_;
    bool is_searched_ = false;            // for all candidates, since the scene was rebuilt
    std::vector<std::uint32_t> active_;   // members that are advanced, if not all are
    std::vector<std::uint32_t> asked_;    // their parts
    std::vector<BroadPhase::Pair> near_;  // pairs that may collide within the step: parts, then members
    std::size_t pairs_ = 0;
    double further_pairs_ = 0;  // for ContactSink::took
    double penetration_ = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> filled_hollows_;  // as of the last call
    double margin_ = 0;                                                    // m, of the present detection pass
    bool level_rims_ = false;                                              // likewise
};

}  // namespace plab::detection
