/// <actuator> of MJCF: motor, position, velocity, general.
#pragma once

#include "import/mjcf_settings.h"

namespace plab::import
{

/// All of `section` that acts on a joint, or on a tendon (Actuator::tendon), and has no state of its own; the rest is listed.
void read_actuators(const XmlElement& section, MjcfSettings& settings, std::vector<Actuator>& out, Document& document);
}  // namespace plab::import
