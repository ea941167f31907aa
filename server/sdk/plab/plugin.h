/// The entry of a plugin: a stamp that the loader checks before anything else, and a function that registers its types.
#pragma once

#include <cstdint>

#include "plab/registrar.h"

namespace plab
{

inline constexpr std::uint32_t kSdkVersion = 1;

/// Changes whenever a structure that crosses the plugin boundary changes its size. A plugin built with other headers, or with flags that
/// change the layout, is refused by name instead of crashing.
constexpr std::uint64_t layout_stamp()
{
    std::uint64_t h = 0xcbf29ce484222325ull;
    for (const std::size_t n : {sizeof(StepContext), sizeof(PhaseCall), sizeof(TypeInfo),     sizeof(CommandInfo), sizeof(Field),
                                sizeof(Role),        sizeof(Bodies),    sizeof(Shafts),       sizeof(Shapes),      sizeof(Geometry),
                                sizeof(Wrenches),    sizeof(Contact),   sizeof(EventBracket), sizeof(Impact),      sizeof(ConstraintRow),
                                sizeof(Island),      sizeof(GapQuery),  sizeof(Event),        sizeof(Value),       sizeof(Result<void>)})
        h = (h ^ n) * 0x100000001b3ull;
    return h;
}

struct PluginStamp
{
    std::uint32_t sdk_version;
    std::uint32_t size;  ///< of this structure
    std::uint64_t layout;
    const char* name;
    const char* compiler;  ///< for messages only
};

#define PLAB_EXPORT __attribute__((visibility("default")))

inline constexpr const char* kStampSymbol = "plab_plugin_stamp";
inline constexpr const char* kRegisterSymbol = "plab_plugin_register";

}  // namespace plab

/// PLAB_PLUGIN("fields", registrar) { registrar.component<...>(...)...; }
#define PLAB_PLUGIN(plugin_name, registrar)                                                                                              \
    extern "C" PLAB_EXPORT const plab::PluginStamp plab_plugin_stamp{plab::kSdkVersion, sizeof(plab::PluginStamp), plab::layout_stamp(), \
                                                                     plugin_name, __VERSION__};                                          \
    extern "C" PLAB_EXPORT void plab_plugin_register(plab::Registrar& registrar)
