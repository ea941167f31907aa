/// One step of one island by sub-steps with soft contacts (soft_step.h), for either kind of packets of its contact points.
#pragma once

#include <vector>

#include "stepping.h"

namespace plab::managers
{

struct SoftChoices
{
    int substeps = 8;
    int relax_iterations = 1;
    double hertz = 60;  ///< natural frequency of a contact; limited to a quarter of the rate of the sub-steps
    double damping_ratio = 10;
    double push_speed = 3;    ///< m/s
    double tolerance = 1e-2;  ///< m/s: a contact in which overlap closes faster than this counts as not held
};

struct SoftMemory
{
    StepMemory step;
    std::vector<SoftPoint<1>> single;  ///< parallel to the points of Problem::single
    std::vector<SoftPoint<4>> fours;
    /// What is special about each contact.
    enum Mark : std::uint8_t
    {
        kMeets = 1,    ///< it was met with a speed when the step began
        kBounces = 2,  ///< and has restitution
        kTurns = 4,    ///< Contact::turning
        kCarried = 8,  ///< it touches a body that is not a mover and may move all the same (kinematic)
    };
    std::vector<std::uint8_t> marks;
    std::vector<std::uint32_t> meeting, carried;  ///< contacts with these marks
    std::vector<MoverSpeeds> moved;               ///< by mover: the velocities of the last move
    std::vector<double> line_sum;
    std::vector<double> line_closing;   ///< m/s or rad/s: closing speed at limits with restitution when the step began; else 0
    std::vector<double> line_greatest;  ///< N s or N m s, largest impulse of any sub-step
    struct Kick
    {
        Vec3 push, turn;  ///< N s, N m s: impulse of the forces in the sub-step
    };
    std::vector<Kick> kicks;

    void reserve(const IslandSize& size)
    {
        step.reserve(size);
        single.reserve(std::min(size.points, kSweptInOrder)), marks.reserve(size.points), meeting.reserve(size.points);
        carried.reserve(size.points), kicks.reserve(size.movers), moved.reserve(size.movers);
        if (size.points > kSweptInOrder) fours.reserve(size.points);
    }
};

template <int W>
class SoftIsland
{
public:
    SoftIsland(Island& island, Bodies& bodies, Shafts& shafts, const SoftChoices& choices, SoftMemory& memory, PacketList<W>& contacts,
               std::vector<SoftPoint<W>>& soft);
    Verdict run();

private:
    void start();
    void load_points();
    void load_pair(Packet<W>& packet, std::uint32_t first, std::uint32_t count, int lane);
    std::uint8_t marks_of(const Contact& contact, bool moves_a, bool moves_b) const;
    void sort_marks();
    void read_given();
    void kick();
    void meet();
    void sum();
    void apply();
    void write();
    void move();
    void relax();
    Moved moved(double h) const { return {memory_.moved, h, 1 / h_}; }
    bool gains(double energy) const;
    bool gains() const;
    int step_hard();
    bool scale_down();
    void sweep_lines(bool soft, std::size_t first = 0);
    void bound_resistances();
    bool holds_rows();
    void hold_rows(bool corrects, bool anew);
    int remove_gained_energy();
    void note_kicks(bool before);
    void count_travel();
    void note_limits();
    void clear_impulses();
    void scale_impulses(double share);
    double bounce(double share);
    void bounce_with_limits(double share);
    void give_back();
    void finish(Verdict& out);

    Island& island_;
    Bodies& bodies_;
    Shafts& shafts_;
    const SoftChoices& choices_;
    SoftMemory& memory_;
    Problem& problem_;
    PacketList<W>& contacts_;  ///< the contact points; problem_ has none
    std::vector<SoftPoint<W>>& soft_;
    double h_;
    SoftSweep sweep_;
    bool bounces_ = false;
    bool applied_ = false;  ///< the impulses have been applied in an earlier sub-step of this step
    bool holds_ = false;    ///< the rows are held exactly
    bool driven_ = false;   ///< the motion of other bodies may add energy at a contact
    double energy_ = 0;     ///< J: kinetic energy when the velocities were written last
    double most_ = 0;       ///< J: kinetic energy after the sub-step's kick, which contacts must not exceed
    bool limits_bounce_ = false;
    double allowed_ = 0;  ///< J: kinetic energy at the start of the step plus the work of the forces since
};

}  // namespace plab::managers
