/// The command line of plab-view.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "link/session.h"
#include "plab/vector.h"
#include "program/command_line.h"

namespace plab::view
{

/// One picture: of the first state at or after `at`, or of the current one without it.
struct Shot
{
    std::optional<double> at;  ///< s, simulated
    std::string camera;        ///< of the scene; empty: the view that the options choose
    std::string file;
};

struct ViewChoice
{
    std::string camera = {};
    std::optional<Vec3> from = {}, look_at = {}, up = {};  ///< W, m
    std::optional<double> orbit = {};                      ///< m; 0: as large as the scene needs
    double orbit_period = 10;                              ///< s, simulated
    std::string track = {};                                ///< component id
};

enum class Task : std::uint8_t
{
    Shots,
    Frames,
    Film,
};

struct ViewerOptions
{
    Task task = Task::Shots;
    std::vector<Shot> shots;         ///< Task::Shots, by time
    std::string target;              ///< Task::Frames: folder; Task::Film: file
    std::optional<double> at;        ///< s: time of the first frame
    double frames_per_second = 30;   ///< of the film
    double rate = 1;                 ///< simulated seconds per second of film
    std::string recording;           ///< file to draw from; empty: a server
    std::optional<double> duration;  ///< s
    std::optional<double> until;     ///< s
    ViewChoice view;
    std::uint32_t width = 1280, height = 720;
    bool captions = true, ground = true;
    bool progress = false;  ///< lines of progress even if standard error is not a terminal
    link::SessionOptions link;
    link::Seconds timeout{10};

    double frames_per_simulated_second() const { return frames_per_second / rate; }
};

/// Why the program ends before it starts: --help, --version (code 0, for standard output) or wrong usage (code 2).
using program::ParseEnd;

/// Empty: `options` is filled.
std::optional<ParseEnd> parse_options(int argc, const char* const* argv, ViewerOptions& options);

/// "T[@CAMERA]=FILE"
Result<Shot> parse_shot(const std::string& text);
/// "x y z", with blanks or commas.
Result<Vec3> parse_vector(const std::string& text);

/// How plab-view ends: exit codes, as those of plabctl.
enum class Exit : int
{
    Done = 0,
    Failed = 1,
    Usage = 2,
    NoServer = 3,
    Interrupted = 130,  ///< by a signal; main() gives 128 + its number
};

struct Outcome
{
    Exit exit = Exit::Done;
    std::string message;  ///< for standard error; empty: nothing to say
};

}  // namespace plab::view
