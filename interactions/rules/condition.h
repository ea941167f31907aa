/// What a rule asks in Lua, for what its parameters cannot say: `applies()`, in the sandbox of Script/Lua.
///
/// The script reads the measures of the pair as parameters (distance, along, radial, angle, radius_a, radius_b), the two objects as driver
/// (a) and driven (b), and may set the rule's values as state, for the template.
#pragma once

#include "plab/result.h"
#include "plab/tables.h"
#include "relation.h"
#include "scripts/lua/machine.h"

namespace plab::rules
{

class Condition
{
public:
    Condition();
    /// The error reads "line 3: ...".
    Result<void> load(const std::string& code, const Entries& values, const StepContext& context, Row row);
    /// Whether it applies; `values` has what the script set. An error says what failed in the script.
    Result<bool> applies(const StepContext& context, Row row, Ref a, Ref b, const Measures& measures, double radius_a, double radius_b,
                         Entries& values, const Bodies& bodies, const Shafts& shafts, const Quantities& quantities);

private:
    scripts::Machine machine_;
    std::string code_;
    bool loaded_for_pairs_ = false;
};

}  // namespace plab::rules
