/// How a service of simulation_interfaces ended.
#pragma once

#include <cstdint>
#include <string>

namespace plab::ros
{

/// simulation_interfaces/msg/Result, and codes above 100 of single services.
enum class Code : std::uint8_t
{
    Unsupported = 0,
    Ok = 1,
    NotFound = 2,
    IncorrectState = 3,
    Failed = 4,

    // SetSimulationState
    AlreadyInState = 101,
    IncorrectTransition = 103,
    // SetEntityState
    InvalidPose = 101,
    // SpawnEntity
    NameNotUnique = 101,
    NameInvalid = 102,
    SpawnFormat = 103,
    SpawnNoResource = 104,
    NamespaceInvalid = 105,
    SpawnParseError = 106,
    SpawnInvalidPose = 109,
    // SpawnEntities
    SomeFailed = 150,
    // LoadWorld
    WorldFormat = 101,
    WorldNoResource = 102,
    WorldParseError = 103,
    UnsupportedElements = 106,
};

struct Outcome
{
    Code code = Code::Ok;
    std::string text{};

    bool ok() const { return code == Code::Ok; }
};

}  // namespace plab::ros
