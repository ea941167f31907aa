/// Rule/Pair: when two objects that match meet, or come near, the components of a template are added between them.
///
/// A pair is (a, b): two frames on two objects, at least one of which is dynamic. It meets when the relation holds (relation.h), the Lua
/// condition applies, and no other rule of the same slot has the pair or takes precedence: a higher priority, or at the same priority the
/// smaller id. It parts when the relation no longer holds with all bounds multiplied by `hold`. In between, a rule acts once.
///
/// With `draw`, the two are first drawn together (Constraint/Snap), until frame b lies on frame a to `latch`; the template replaces that.
/// Sources: A. Witkin, M. Gleicher, W. Welch, Interactive dynamics, SIGGRAPH 1990; R. Smith, Dynamics simulation, 2001.
#pragma once

#include <memory>
#include <string>

#include "memory.h"
#include "plab/registrar.h"

namespace plab::rules
{

/// Patterns of one side.
struct SideColumns
{
    Column<std::string> ids, type, shape, connector;
    Column<std::int64_t> most;

    void describe(Schema& schema, const std::string& side);
    Wanted wanted(Row row) const { return {ids[row], type[row], shape[row], connector[row]}; }
};

struct RuleRows
{
    SideColumns a, b;
    Column<std::string> relation;
    Column<double> reach, tolerance, along, angle, hold;
    Column<std::string> text;  ///< the template
    Column<bool> removes;
    Column<std::int64_t> priority;
    Column<std::string> slot;
    Column<std::string> code;
    Column<Entries> values;
    Column<double> draw, latch, latch_angle, latch_speed;  ///< Hz, m, rad, m/s
    Column<std::string> draw_by;
    Column<bool> turns;
    Column<std::string> couples;  ///< an expression
    Column<Entries> links;        ///< state
    Column<std::int64_t> made;    ///< state: how many it has made so far
    Column<std::unique_ptr<Memory>> memory;

    void describe(Schema& schema);
    Bounds bounds(Row row) const { return {relation_of(relation[row]), reach[row], tolerance[row], along[row], angle[row]}; }
};

/// Phase::Prepare: refuses a template or code that cannot be read.
Result<void> prepare_rule(const StepContext& context, Row row, RuleRows& rules);
/// Phase::Decide: asks for what has to be added and removed.
void apply_rules(const StepContext& context, Rows rows, RuleRows& rules, const Bodies& bodies, const Shafts& shafts,
                 const Quantities& quantities, RequestSink& requests);

}  // namespace plab::rules
