/// CDetection/ODE: finds contacts among bodies with ODE's collision spaces.
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

/// Phase::Prepare: forgets what was built; bodies and shapes may not be ready yet, so detect builds.
void prepare(Row row, OdeRows& rows);
/// Phase::Gap: after a look in the same step.
Result<void> measure_gap(Row row, OdeRows& rows, const Bodies& bodies, GapQuery& query);
/// Phase::Detect.
Result<void> detect(const StepContext& context, Row row, OdeRows& rows, const Bodies& bodies, const Shapes& shapes, ContactSink& sink);

}  // namespace plab::detection
