/// The relative velocities at the contacts of an impact, and how impulses change them.
///
/// Where bodies are free, impulses change their velocities at once. Where joints hold them, an impulse acts on all bodies of the mechanism,
/// and the host tells what that does to each contact (Impact::mobility, also known as the Delassus operator): bodies keep their velocities
/// then, and the host applies the impulses that have been found.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact_point.h"

namespace plab::response
{

class ContactVelocities
{
public:
    /// Reads the velocities of `bodies`, which must outlive this object's use.
    void begin(std::span<const Contact> contacts, Bodies& bodies, std::span<const Mat3> mobility);
    /// Whether joints hold bodies, so that each impulse may act on all contacts.
    bool are_joined() const { return !mobility_.empty(); }
    /// Whether an impulse can change the contact's normal velocity.
    bool moves(std::uint32_t contact) const { return are_joined() ? K(contact)(2, 2) > 0 : points_[contact].moves(); }
    /// u: m/s, in contact coordinates.
    Vec3 at(std::uint32_t contact) const { return are_joined() ? velocities_[contact] : points_[contact].velocity(*bodies_); }
    /// 1/kg, in contact coordinates: du = K dj at the contact itself.
    const Mat3& K(std::uint32_t contact) const { return are_joined() ? own_[contact] : points_[contact].K(); }
    /// Applies j (N s, contact coordinates) at a contact. Of free bodies, `normal_velocity` is the u_n that results
    /// (ContactPoint::apply).
    void apply(std::uint32_t contact, const Vec3& j, double normal_velocity);
    Vec3 to_world(std::uint32_t contact, const Vec3& v) const { return points_[contact].to_world(v); }
    Vec3 to_contact(std::uint32_t contact, const Vec3& v_W) const { return points_[contact].to_contact(v_W); }

    /// Remembers the velocities that impulses at these contacts may change; put_back() sets them again.
    void keep(std::span<const std::uint32_t> contacts);
    void put_back();

private:
    /// A body before an impact.
    struct Kept
    {
        std::uint32_t body = 0;
        Vec3 velocity, spin, momentum;
    };

    void find_own();

    Bodies* bodies_ = nullptr;
    std::span<const Contact> contacts_;
    std::span<const Mat3> mobility_;
    std::vector<ContactPoint> points_;
    std::vector<Vec3> velocities_, kept_velocities_;  ///< m/s, contact coordinates, where joints hold bodies
    std::vector<Mat3> own_;                           ///< the diagonal blocks of the mobility, contact coordinates
    std::vector<Kept> kept_;
    std::vector<std::uint32_t> touched_;  ///< bodies
};

}  // namespace plab::response
