/// The rotation of a body or shaft about an axle of its own, relative to a base (a body, a shaft or the world), over many turns;
/// and the terms that its speed contributes to rows.
///
///   speed = n . (w - w_base),  n fixed in the body          d(speed)/dt = n . (w' - w_base') - (w x n) . w_base
/// Shafts turn about their own axles: n . w is their speed.
#pragma once

#include "joints/pair.h"

namespace plab::constraints
{

/// The rotation of one participant at the present state.
struct Spin
{
    Ref participant, base;
    Vec3 n;              ///< in W; for a shaft only x is used
    double twist = 0;    ///< rad; for bodies within half a turn
    double speed = 0;    ///< rad/s
    double extra = 0;    ///< (w x n) . w_base, rad/s^2
    bool wraps = false;  ///< `twist` does not include whole turns
};

/// Adds `factor` times this speed to a row: its blocks, and the corresponding bias. Blocks of the same participant are merged.
void add_spin(const Spin& spin, double factor, ConstraintRow& row);

/// A coordinate at the present state, with its row: J and bias of its speed, but no error yet.
struct Coordinate
{
    double x = 0, speed = 0;  ///< rad or m; rad/s or m/s
    ConstraintRow row;
};
/// The turn of a participant. `angle`: rad, with whole turns.
Coordinate turning(const Spin& spin, double angle);
/// The slide of b along t (unit, in W, fixed in a): t . d.
Coordinate sliding(const Sides& s, const Vec3& t);

/// An axle, and the angle about it. Angles are kept as state, so that they remain exact over any number of turns.
struct SpinColumns : AxisColumns, MeterColumns
{
    /// `prefix` of the field names, such as "driver_".
    void describe_axle(Schema& s, const std::string& prefix, const std::string& whose);
    /// The same, and the angle about it.
    void describe_spin(Schema& s, const std::string& prefix, const std::string& whose);
    /// Phase::Prepare: sets the axle from its parameter, if that is new.
    Result<void> place(Row row, Ref participant, Ref base, const Bodies& bodies);
    Spin spin_of(Row row, Ref participant, Ref base, const Bodies& bodies, const Shafts& shafts) const;
    /// Phase::Drive: the angle at the start of the first step.
    void begin(Row row, const Spin& spin, double now)
    {
        if (!is_read(row)) angle[row] = spin.twist, start(row, spin.speed, now);
    }
    double angle_now(Row row, const Spin& spin, double now) const
    {
        return spin.wraps ? read(row, spin.twist, spin.speed, now) : spin.twist;
    }
    /// Phase::Finish.
    void keep_spin(Row row, const Spin& spin, double now)
    {
        angle[row] = angle_now(row, spin, now);
        start(row, spin.speed, now);
    }
};

}  // namespace plab::constraints
