/// pLab in the comparison: in-process, one thread, no bus.
#pragma once

#include "bench/peers/engine.h"
#include "bench/peers/plab_scene.h"

namespace plab::peers
{

/// Loads `text` as a scene of its own. On error the reason is pLab's own message.
Result<std::unique_ptr<Engine>> make_plab_engine(const std::string& text, std::size_t bodies);

/// Names in `text` that look like types and that no plugin of this build has, e.g. "Solver/Radau5".
std::vector<std::string> missing_types(const std::string& text);

}  // namespace plab::peers
