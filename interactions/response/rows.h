/// Response/Rows: contacts become rows of an island that a manager advances. If a resolution locates impacts, these are answered
/// here, all contacts of an impact simultaneously.
///
/// Moreau's law of impact with Newton's restitution:
///
///   u_n' >= -e u_n where u_n < 0, else >= 0;   complementary to j_n >= 0;   Coulomb's cone for the tangential part of j
///
/// Without friction the resulting velocities are unique and independent of the order of bodies: a symmetric impact has a
/// symmetric result, and with e = 1 energy is conserved.
/// Sources: Moreau (1988); Glocker, Set-Valued Force Laws (2001), chapter 9.
#pragma once

#include "impulse.h"

namespace plab::response
{

struct RowsRows
{
    Column<double> friction, restitution;                // 1
    Column<double> rolling_friction, spinning_friction;  // m
    Column<Ref> manager;
    Column<double> rest_height;  // m
    Column<double> rest_speed;   // m/s
    Column<double> residual;     // m/s
    Column<std::int64_t> iterations;
    Column<Tick> step;  ///< the step whose outputs are being summed
    Column<Workspace> workspace;

    void describe(Schema& schema);
};

/// Phase::Respond.
void respond_rows(const StepContext& context, Row row, RowsRows& rows, Bodies& bodies, Impact& impact);

}  // namespace plab::response
