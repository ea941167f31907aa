/// Response/Automatic: the impact law of Response/Impulse, and a manager for contacts that persist.
///
/// Impacts that a resolution locates are answered one pair after the other, in the order in which they happen (Newton's cradle passes its
/// momentum on). Everything else is left to the manager: bodies that rest on one another, and all impacts of a step whose resolution does
/// not locate them.
#pragma once

#include "impulse.h"

namespace plab::response
{

struct AutomaticRows
{
    ImpulseRows impulse;
    Column<Ref> manager;

    void describe(Schema& schema);
};

/// Phase::Respond.
void respond_automatically(const StepContext& context, Row row, AutomaticRows& rows, Bodies& bodies, Impact& impact);

}  // namespace plab::response
