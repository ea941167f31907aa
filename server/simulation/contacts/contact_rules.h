/// Which resolution goes with which response: what makes no sense is refused when a scene is loaded or a component
/// exchanged; what is merely not used is stated.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "plab/result.h"
#include "simulation/contacts/contacts.h"

namespace plab::simulation
{

/// Refused, with the detector as the element:
///   - a resolution that speculates without a response by rows: nobody would let the gaps close;
///   - a resolution that certifies with a detection that measures no gaps;
///   - two detections that both answer one pair of bodies: each would push as if the other were not there. A sensor
///     (Response/None) beside another detection is fine.
Errors check_contacts(const world::World& world, std::span<const Detector> detectors);

/// Sentences on what a scene names and does not use, for `--explain`:
///   - a resolution that locates, or certifies, beside a response that is a force.
std::vector<std::string> unused_in_contacts(const world::World& world, std::span<const Detector> detectors);

}  // namespace plab::simulation
