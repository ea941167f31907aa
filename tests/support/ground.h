/// The level floor z = 0 under most scenes with contacts: `ground`.
#pragma once

namespace plab::test
{

inline const char* const kGround =
    "<component id=\"ground\" type=\"State/Static\" shape=\"floor\"/><component id=\"floor\" type=\"Shape/Plane\"/>";

}  // namespace plab::test
