// 10,000 bodies of which 100 move, for tests of the bus at scale.
#pragma once

#include <fstream>
#include <string>

#include "server.h"

namespace plab::test
{

inline constexpr std::size_t kBodies = 10'000, kMoving = 100;

/// A hundred rows of a hundred bodies; the first row turns.
inline std::string field_of_bodies()
{
    const std::string file = scratch_file("field_10000.xml");
    std::ofstream(file) << "<plab version=\"1\"><scene dt=\"1/60\"/><component id=\"s\" type=\"Shape/Sphere\" radius=\"0.1\"/>"
                           "<repeat id=\"moving\" count=\"100 1\" step=\"1 1 0\"><component id=\"a\" type=\"State/Kinematic\" shape=\"s\""
                           " angular_velocity=\"0 0 1\"/></repeat>"
                           "<repeat id=\"resting\" count=\"100 99\" step=\"1 1 0\"><component id=\"b\" type=\"State/Kinematic\" shape=\"s\""
                           " position=\"0 1 0\"/></repeat></plab>";
    return file;
}

}  // namespace plab::test
