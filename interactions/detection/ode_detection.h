/// CDetection/ODE: finds the contacts among bodies. The broad phase is pLab's own tree or one of ODE's collision spaces; the
/// whole narrow phase is pLab's own.
#pragma once

#include <memory>
#include <string>

#include "ode_scene.h"
#include "plab/result.h"
#include "plab/schema.h"

namespace plab::detection
{

struct OdeRows
{
    Column<RefList> between, against;
    Column<Ref> resolution, response;
    Column<std::string> space;
    Column<std::int64_t> pairs;
    Column<double> penetration;
    Column<std::unique_ptr<OdeScene>> scene;

    void describe(Schema& schema);
};

/// Phase::Prepare: discards what was built. Bodies and shapes may not be complete yet, so detect() builds it again.
void prepare(Row row, OdeRows& rows);
/// Phase::Gap: must follow a detection pass in the same step.
Result<void> measure_gap(Row row, OdeRows& rows, const Bodies& bodies, const CollisionFilter& filter, GapQuery& query);
/// Phase::Detect.
Result<void> detect(const StepContext& context, Row row, OdeRows& rows, const Bodies& bodies, const Shapes& shapes,
                    const CollisionFilter& filter, ContactSink& sink);

}  // namespace plab::detection
