/// The bodies and shapes of one CDetection/ODE, as ODE's collision space and the narrow phase need them.
#pragma once

#include <string>
#include <vector>

#include "broad.h"
#include "narrow.h"
#include "plab/collision.h"
#include "plab/context.h"

namespace plab::detection
{

/// What one component keeps: made from bodies and shapes alone, so it needs no saving; rebuilt whenever they differ
/// from what it was made from.
class OdeScene
{
public:
    /// Brings parts and poses up to date. Returns whether it had to be rebuilt. A context that advances some bodies only
    /// comes after a look at all in the same step: then nothing but their poses can be new.
    bool update(const StepContext& context, const std::string& space, const RefList& between, const RefList& against, const Bodies& bodies,
                const Shapes& shapes, const ContactSink& order);
    /// Contacts of all pairs of which `context` advances one, standing pairs first; where the sink gives a reach, the
    /// pairs that may meet instead.
    void detect(const StepContext& context, const Bodies& bodies, ContactSink& sink);
    /// How far the two bodies of the query are apart at their present poses: over all pairs of their shapes. Infinite
    /// where none of them collide. The scene is the one of the last update(): only poses may have changed since.
    void measure(GapQuery& query, const Bodies& bodies) const;

    std::size_t pairs() const { return pairs_; }
    double penetration() const { return penetration_; }  ///< m, deepest overlap of the last look
    const std::vector<Collider>& colliders() const { return colliders_; }
    const std::vector<std::uint32_t>& shapes() const { return shape_of_collider_; }

private:
    struct Member  // a body that takes part
    {
        std::uint32_t body = 0;
        Membership membership;
        std::uint32_t first_part = 0, end_part = 0;
        std::uint32_t first_shape = 0, end_shape = 0;  // in body_shapes_
        Vec3 position;                                 // as moved last
        Quat orientation;
    };
    struct Part  // a shape on a body, or a part of a compound
    {
        std::uint32_t member = 0;
        std::uint32_t collider = 0;
        Pose in_body;  // X_BS
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
    void add_part(std::uint32_t member, std::uint32_t shape, const Pose& X_BP);
    void move_parts(const Bodies& bodies, bool all);
    void move_active(const StepContext& context, const Bodies& bodies);
    void move_member(Member& member, const Bodies& bodies);
    bool may_meet(const Member& a, const Member& b, const StepContext& context) const;
    void report_near(const StepContext& context, ContactSink& sink);
    void collect_persistent(const StepContext& context, const ContactSink& sink);
    bool is_persistent(std::uint32_t a, std::uint32_t b) const;
    Pose place(const Part& part, const Vec3& p_OC, const Bodies& bodies) const;
    void look(std::uint32_t part_a, std::uint32_t part_b, const Vec3& shift, const Bodies& bodies);
    void query_persistent(const Bodies& bodies, ContactSink& sink);
    void query_near(const StepContext& context, const Bodies& bodies, ContactSink& sink);
    void flush(const Member& a, const Member& b, double shift, ContactSink& sink);

    // What it was made from.
    std::string space_;
    RefList between_, against_;
    std::vector<std::uint32_t> body_shapes_;        // by member
    std::vector<std::uint32_t> shape_of_collider_;  // sorted

    std::vector<Member> members_;  // in the order of ids
    std::vector<Part> parts_;      // by member, then in the order of the body's shapes, then of a compound's parts
    std::vector<Collider> colliders_;
    BroadPhase broad_;

    // Scratch of one look.
    std::vector<std::uint32_t> member_of_body_;
    std::vector<PersistentQuery> persistent_;
    ContactPoints contact_points_;
    std::vector<ContactPoint> found_;
    NearSweep sweep_;
    std::vector<std::uint32_t> asked_;    // parts of the bodies that are advanced
    std::vector<BroadPhase::Pair> near_;  // members
    std::size_t pairs_ = 0;
    std::size_t parts_met_ = 0;  // of the present pair of bodies
    double further_pairs_ = 0;   // as ContactSink::took has it
    double penetration_ = 0;
    double margin_ = 0;  // m, of the present look
};

}  // namespace plab::detection
