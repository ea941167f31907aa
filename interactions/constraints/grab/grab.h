/// Constraint/Grab: a hand holds a body by a spring with a damper, so softly that neither can be torn apart, and with limited force.
///
/// P is a point of the body, H the origin of the hand's frame; m, I: mass of the body, and inertia about its centre of mass in W. s is the
/// rotation vector from the body's attitude to the one that it had in the hand when it was grabbed.
///   f = k (p_H - p_P) + c (v_H - v_P)                 on the body at P, |f| <= max_force
///   t = I (w^2 s + 2 zeta w (w_H - w_B))              on the body,      |t| <= max_torque
///   k = m w^2, c = 2 zeta m w, w = 2 pi frequency; or k = stiffness, c = 2 zeta sqrt(k m)
/// The hand feels -f at P and -t. Frequency and damping ratio are those of the body alone, held at its centre, as in the mouse joint of
/// Box2D (E. Catto, Soft constraints, GDC 2011).
///
/// The hand closes when its `grip` rises to `close_at`, and opens when it falls to `open_at`. Closing, it holds the body that it touches,
/// by the point where the hand is; or else the nearest one within `reach`. A named body (`hold`) is held by its centre of mass, wherever
/// the hand is, as long as it is named. What is let go keeps its velocity: only the force ends.
#pragma once

#include "plab/registrar.h"

namespace plab::constraints
{

struct GrabRows
{
    Column<Ref> user;
    Column<RefList> body;
    Column<std::string> hold;  ///< input: id
    // Parameters
    Column<double> frequency, damping_ratio, stiffness;  ///< Hz, 1, N/m (0: from the frequency)
    Column<double> max_force, max_torque, reach;         ///< N, N m, m
    Column<double> close_at, open_at;                    ///< of the grip
    // States
    Column<std::string> held, touched;  ///< ids
    Column<bool> closed;
    Column<Vec3> point;     ///< P from the centre of mass, in the body's axes, m
    Column<Quat> attitude;  ///< q_HB when it was grabbed
    // Outputs
    Column<Vec3> force, torque;  ///< on the body, in W
    Column<double> distance;     ///< m, from P to H
    struct Held
    {
        Ref body;
    };
    Column<Held> now;  ///< scratch: what `held` names, in this step

    void describe(Schema& schema);
};

/// Force and torque on the held body at the present state.
struct Grasp
{
    Vec3 p, force, torque;  ///< P, m
    double distance = 0;
};
Grasp grasp_of(const GrabRows& grabs, Row row, const Bodies& bodies);

/// Phase::Drive: closes and opens the hand.
void open_and_close(const StepContext& context, Rows rows, GrabRows& grabs, const Bodies& bodies, const Shapes& shapes);
/// Phase::Force.
void pull(const StepContext& context, Rows rows, const GrabRows& grabs, const Bodies& bodies, Wrenches& wrenches);
/// Phase::Finish.
void finish_grab(const StepContext& context, Rows rows, GrabRows& grabs, const Bodies& bodies, Touches& touches);

}  // namespace plab::constraints
