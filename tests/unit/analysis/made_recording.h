/// A recording in which every number is known: two bodies and a shaft, a contact whose response is exchanged, a reset.
///
/// At time t: red at (t, sin t, 2), spinning about z; blue at (0, 0, t^2); the axle's angle is 3 t. Steps are 0.01 s.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "idl/recording/cdr.h"
#include "idl/recording/writer.h"

namespace plab::test
{

struct MadeOptions
{
    std::int64_t steps = 200;         ///< of the first run
    std::int64_t steps_after = 0;     ///< of a second one, after a reset; 0: there is none
    std::int64_t frame_every = 1;     ///< steps
    std::int64_t swap_at = 100;       ///< step before which the response is exchanged
    std::int64_t differs_from = -1;   ///< from this step on, red's y is larger by `difference`, which doubles each 10 steps
    double difference = 1e-13;        ///< m
    std::int64_t missing_frame = -1;  ///< step of a frame that has a number, and is not there
    bool only_moved = false;          ///< frames name only objects that moved since the last one; the first names all
    bool with_catalogue = true;
    bool with_axle = true;
    int governed = 0;  ///< solvers under the governor "lod", all at the cheap level; from `swap_at` on every third one is at the fine one
    bool with_journal = true;
    bool with_hashes = true;
    bool is_closed = true;  ///< false: as after a crash
    recording::Compression compression = recording::Compression::Zstd;
};

inline constexpr double kMadeStep = 0.01;                               // s
inline constexpr std::uint64_t kMadeStart = 1'700'000'000'000'000'000;  // ns since 1970
inline constexpr std::uint64_t kMadeStepNs = 10'000'000;

/// Where red is.
struct MadePlace
{
    double x = 0, y = 0, z = 0;
};
MadePlace made_red(double time);
/// The hash that is written for a step.
std::uint64_t made_hash(std::uint64_t run, std::int64_t step, bool differs);

/// Writes it to a file of this test's own; returns its path.
std::string make_recording(const std::string& name, const MadeOptions& options = {});

/// A path in the build folder at which no file exists yet.
std::string fresh_path(const std::string& name);

}  // namespace plab::test
