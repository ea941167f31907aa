/// The descriptors that plab-bus finds open when it starts.
#pragma once

namespace plab::bus
{

inline constexpr int kInheritedFirst = 3;
inline constexpr int kInheritedMemory = 3;    ///< PipeMemory
inline constexpr int kInheritedWake = 4;      ///< eventfd that plab-bus sleeps on
inline constexpr int kInheritedServer = 5;    ///< eventfd that plabd sleeps on
inline constexpr int kInheritedLifeline = 6;  ///< a socket that is closed when plabd has ended
inline constexpr int kInheritedEnd = 7;

}  // namespace plab::bus
