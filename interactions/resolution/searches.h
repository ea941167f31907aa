/// Resolution/*: when, within a step, two bodies meet. The algorithms from the cheapest to the most accurate.
///
/// The host asks for the next time to try (Phase::Locate) with a bracket [begin, end] and the gaps at both ends, and goes on until the
/// answer is to accept the time, or to give up.
#pragma once

#include "plab/collision.h"
#include "plab/context.h"
#include "plab/schema.h"

namespace plab::resolution
{

/// Resolution/None: no location. An impact is answered at the end of the step in which it is detected.
struct NoneRows
{
    void describe(Schema&) {}
};
void accept_end(const StepContext& context, Row row, const NoneRows& rows, EventBracket& trial);

/// Resolution/Bisection and Resolution/LocalBisection: halves the bracket [begin, end], at whose begin the bodies are separated and at
/// whose end they overlap. After n trials its length is h 2^-n. Nothing is assumed of the gap but that its sign can be seen.
struct BisectionRows
{
    Column<double> time_tolerance;        // s
    Column<double> max_work;              // 1
    Column<std::int64_t> max_iterations;  // trials

    void describe(Schema& schema);
};
/// Phase::Locate. Resolution/Bisection rewinds the whole world for each trial (as in the paper), Resolution/LocalBisection only
/// the group of touching bodies.
void bisect(const StepContext& context, Row row, const BisectionRows& rows, EventBracket& trial);

/// Declares the parameter `acceleration`, by which gaps are judged.
void describe_acceleration(Schema& schema, Column<double>& acceleration);

/// Resolution/Speculative: locates no events; gaps that may close within the step are treated as contacts as well. For responses by rows:
/// the manager lets a gap close but not overlap, so that bodies stop at the surface. Nothing is rewound.
/// Source: E. Catto, Continuous collision, GDC (2013).
struct SpeculativeRows
{
    Column<double> acceleration;  // m/s^2

    void describe(Schema& schema);
};
/// Phase::Locate: accepts the end of the step, as contacts by rows are not events.
void accept_speculation(const StepContext& context, Row row, const SpeculativeRows& rows, EventBracket& trial);

/// Resolution/ConservativeAdvancement: approaches a contact from the separated side in steps that cannot pass it.
///
///   t' = t + gap(t) / closing,    closing >= any speed at which the gap can shrink in the rest of the piece
///
/// The host provides this bound; it covers linear speeds along the normal, forces, and rotation about the centres. Source:
/// Mirtich, Impulse-based Dynamic Simulation, PhD thesis, UC Berkeley (1996), section 2.3.
struct AdvancementRows
{
    Column<double> gap_tolerance;         // m
    Column<double> max_work;              // 1
    Column<std::int64_t> max_iterations;  // steps

    void describe(Schema& schema);
};
/// Phase::Locate.
void advance_to_contact(const StepContext& context, Row row, const AdvancementRows& rows, EventBracket& trial);

/// Resolution/LocalRoot: the first zero of the signed gap.
///
/// As long as no overlap is known, it proceeds from the separated side in steps that cannot pass a contact, by the host's bound
/// on how the gap can shrink. Near a contact this bound approaches the rate of the gap itself, so this is Newton's method from
/// the safe side.
///
/// Once an overlap at the end of the bracket is known, it uses cubic Hermite interpolation of the gaps and their rates at both
/// ends, restricted to the bracket, and halves the bracket wherever halving would have come further. So the worst case is that of
/// bisection, as in I. Oliveira, R. Takahashi, An enhancement of the bisection method average performance preserving minmax optimality,
/// ACM TOMS 47 (2020). The host checks that nothing touched before the zero; if it cannot,
/// it continues with safe steps.
struct RootRows
{
    Column<double> time_tolerance;        // s
    Column<double> max_work;              // 1
    Column<std::int64_t> max_iterations;  // distance queries

    void describe(Schema& schema);
    /// All but max_work.
    void describe_search(Schema& schema);
};
/// Phase::Locate.
void find_root(const StepContext& context, Row row, const RootRows& rows, EventBracket& trial);

/// Zero of the cubic through (t0, g0 > 0) and (t1, g1 < 0) with slopes r0 and r1 (NaN: slope of the chord), inside (t0, t1).
double hermite_zero(double t0, double g0, double r0, double t1, double g1, double r1);

}  // namespace plab::resolution
