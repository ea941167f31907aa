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
    /// Brings parts and poses up to date. Returns whether it had to be rebuilt.
    bool update(const std::string& space, const RefList& between, const RefList& against, const Bodies& bodies, const Shapes& shapes,
                const ContactSink& order);
    /// Contacts of all pairs of which `context` advances one, standing pairs first.
    void detect(const StepContext& context, const Bodies& bodies, ContactSink& sink);

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
        Vec3 position;  // as moved last
        Quat orientation;
    };
    struct Part  // a shape on a body
    {
        std::uint32_t member = 0;
        std::uint32_t collider = 0;
    };
    struct Standing
    {
        std::uint32_t a = 0, b = 0;  // members
        Vec3 shift;
    };

    bool is_current(const std::string& space, const RefList& between, const RefList& against, const Bodies& bodies, const Shapes& shapes,
                    const ContactSink& order) const;
    void rebuild(const Bodies& bodies, const Shapes& shapes, const ContactSink& order);
    void add_members(const RefList& bodies, bool between, const Bodies& table);
    void add_colliders(const Bodies& bodies, const Shapes& shapes);
    void move_parts(const Bodies& bodies, bool all);
    bool may_meet(const Member& a, const Member& b, const StepContext& context) const;
    void collect_standing(const StepContext& context, const ContactSink& sink);
    bool is_standing(std::uint32_t a, std::uint32_t b) const;
    void look(std::uint32_t part_a, std::uint32_t part_b, const Vec3& shift, const Bodies& bodies);
    void flush(const Member& a, const Member& b, double shift, ContactSink& sink);

    // What it was made from.
    std::string space_;
    RefList between_, against_;
    std::vector<std::uint32_t> body_shapes_;        // shape of each part
    std::vector<std::uint32_t> shape_of_collider_;  // sorted

    std::vector<Member> members_;  // in the order of ids
    std::vector<Part> parts_;      // by member, then in the order of the body's shapes
    std::vector<Collider> colliders_;
    BroadPhase broad_;

    // Scratch of one look.
    std::vector<std::uint32_t> member_of_body_;
    std::vector<Standing> standing_;
    Touches touches_;
    std::vector<Touch> found_;
    std::size_t pairs_ = 0;
    double penetration_ = 0;
};

}  // namespace plab::detection
