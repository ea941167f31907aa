/// Checks which resolutions and responses fit together. Combinations that cannot work are refused when a scene is loaded or a component is
/// exchanged; parameters that merely have no effect are reported.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "plab/result.h"
#include "simulation/contacts/contacts.h"

namespace plab::simulation
{

/// Errors, with the detector as the element, for
///   - a resolution that speculates without a response by rows: other responses would hold bodies apart at the gap;
///   - a resolution that certifies with a detection that cannot measure gaps;
///   - two detections that both answer the same pair of bodies: each would push as if the other did not exist. A sensor
///     (Response/None) in addition to another detection is fine.
Errors check_contacts(const world::World& world, std::span<const Detector> detectors);

/// Sentences about components of a scene that have no effect, for `--explain`:
///   - a resolution that locates, or certifies, together with a response that is a force.
std::vector<std::string> unused_in_contacts(const world::World& world, std::span<const Detector> detectors);

}  // namespace plab::simulation
