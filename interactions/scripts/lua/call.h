/// One call from the host into a script: what the script may see and change.
#pragma once

#include <cstdint>
#include <vector>

#include "plab/context.h"
#include "plab/ref.h"
#include "plab/tables.h"
#include "plab/value.h"
#include "plab/vector.h"

namespace plab::scripts
{

enum class EntryPoint : std::uint8_t
{
    Load,   ///< the code as a whole, once
    Drive,  ///< once per step
    Force,  ///< at every solver stage; pure
};

struct Call
{
    EntryPoint entry = EntryPoint::Load;
    const StepContext* context = nullptr;
    Row row = 0;
    const Bodies* bodies = nullptr;  ///< null while loading
    const Shafts* shafts = nullptr;
    const Quantities* quantities = nullptr;
    Ref driver, driven;
    const RefList* between = nullptr;
    const Entries* parameters = nullptr;
    const Entries* state = nullptr;
    Entries* writable_state = nullptr;     ///< Drive only; the same as `state`
    std::int64_t* random_state = nullptr;  ///< Drive only
};

/// A force requested by a call. It is applied only after the call has succeeded, so a failing call adds nothing.
struct Action
{
    enum class Kind : std::uint8_t
    {
        Force,
        ForceAt,
        Torque,
        ShaftTorque,
        Rate,
    };
    Kind kind = Kind::Force;
    Ref on;
    Vec3 value;               ///< N or N m, W; ShaftTorque, Rate: x
    Vec3 at;                  ///< m, W; ForceAt
    std::uint32_t place = 0;  ///< index of the value; Rate
};

}  // namespace plab::scripts
