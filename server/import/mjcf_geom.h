/// A <geom> of MJCF: shape and mass.
#pragma once

#include <optional>

#include "import/mjcf_settings.h"

namespace plab::import
{

struct MjcfGeom
{
    RobotShape shape;
    MassProperties mass;  ///< in the body; zero for planes
};

/// `e` with its defaults. None if it is left out (listed) or faulty (an error). `has_mass`: its mass counts; otherwise it may be open.
std::optional<MjcfGeom> read_geom(const XmlElement& e, bool has_mass, MjcfSettings& settings, Document& document);

}  // namespace plab::import
