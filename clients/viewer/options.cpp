#include "viewer/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "completion/server_values.h"
#include "idl/topics.h"
#include "link/numbers.h"

namespace plab::view
{
namespace
{

constexpr const char* kExamples = R"(Examples:
  plab-view --png now.png
  plab-view --png start.png --at 0.5 --camera behind
  plab-view --shot 0=start.png --shot 1.2=hit.png --shot 3@behind=end.png
  plab-view --frames pictures --fps 5 --duration 2
  plab-view --mp4 run.mp4 --until 10 --orbit 6 --orbit-period 10
  plab-view --png red.png --track red --from "2 -3 2"
  plab-view run.mcap --png hit.png --at 1.2
  plab-view run.mcap --mp4 slow.mp4 --at 1 --until 2 --rate 0.1

With FILE, the pictures show a recording; without it, a running server. Times are simulated seconds. The view: --camera, or --from, --look-at, --orbit; without any of them the scene's camera
'front', else its first one, else a view that shows everything.

Environment: PLAB_SERVER, PLAB_DOMAIN, PLAB_INTERFACE replace the options of these names.
Exit codes: 0 done, 1 failed or not all pictures could be had, 2 wrong usage, 3 no server or time-out, 130 Ctrl-C, 143 SIGTERM.)";

struct Texts
{
    std::string png, frames, film, from, look_at, up;
    std::vector<std::string> shots;
    std::optional<double> timeout;
    bool no_captions = false, no_ground = false;
};

std::optional<double> parse_number(std::string_view text)
{
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return value;
}

void add_pictures(CLI::App& app, ViewerOptions& options, Texts& texts)
{
    app.add_option("--png", texts.png, "write one picture")->type_name("FILE")->group("Pictures");
    app.add_option("--shot", texts.shots, "one picture of the first state at or after T (may be repeated)")
        ->type_name("T[@CAMERA]=FILE")
        ->take_all()
        ->allow_extra_args(false)
        ->group("Pictures");
    app.add_option("--frames", texts.frames, "write frame_0000.png and so on, at equal simulated times")
        ->type_name("DIR")
        ->group("Pictures");
    app.add_option("--mp4", texts.film, "write a film (needs ffmpeg)")->type_name("FILE")->group("Pictures");
    app.add_option("file", options.recording, "recording to draw from; default: a running server")->type_name("FILE");
    app.add_option("--at", options.at, "time of the picture, or of the first frame; default: now, or the beginning of a recording")
        ->check(link::check_not_negative)
        ->type_name("T")
        ->group("Pictures");
    app.add_option("--fps", options.frames_per_second, "frames per second of the film")
        ->check(link::check_positive)  // nan is in every range
        ->check(CLI::Range(0.001, 1e5))
        ->capture_default_str()
        ->group("Pictures");
    app.add_option("--rate", options.rate, "simulated seconds per second of film")
        ->check(link::check_positive)
        ->check(CLI::Range(0.001, 1000.))
        ->type_name("R")
        ->capture_default_str()
        ->group("Pictures");
    auto* const duration = app.add_option("--duration", options.duration, "seconds from the first frame; default: until Ctrl-C")
                               ->check(link::check_positive)
                               ->type_name("S")
                               ->group("Pictures");
    app.add_flag("--progress", options.progress, "print the progress every five seconds on standard error, even if that is not a terminal")
        ->group("Pictures");
    app.add_option("--until", options.until, "time of the last frame")
        ->check(link::check_not_negative)
        ->type_name("T")
        ->excludes(duration)
        ->group("Pictures");
}

void add_view(CLI::App& app, ViewerOptions& options, Texts& texts)
{
    auto* const camera = app.add_option("--camera", options.view.camera, "camera of the scene")->type_name("NAME")->group("View");
    auto* const from =
        app.add_option("--from", texts.from, "position of the camera")->type_name("\"X Y Z\"")->excludes(camera)->group("View");
    app.add_option("--look-at", texts.look_at, "point to look at")->type_name("\"X Y Z\"")->excludes(camera)->group("View");
    app.add_option("--up", texts.up, "up direction of the picture")->type_name("\"X Y Z\"")->group("View");
    app.add_option("--orbit", options.view.orbit, "move the camera on a circle of this radius; 0: as large as the scene needs")
        ->check(link::check_not_negative)
        ->type_name("RADIUS")
        ->excludes(camera)
        ->excludes(from)
        ->group("View");
    app.add_option("--orbit-period", options.view.orbit_period, "simulated seconds per revolution")
        ->check(link::check_positive)
        ->type_name("S")
        ->capture_default_str()
        ->group("View");
    app.add_option("--track", options.view.track, "follow this object as it moves")->type_name("ID")->group("View");
    app.add_option("--width", options.width, "pixels")->check(CLI::Range(16, 8192))->capture_default_str()->group("View");
    app.add_option("--height", options.height, "pixels")->check(CLI::Range(16, 8192))->capture_default_str()->group("View");
    app.add_flag("--no-captions", texts.no_captions, "draw no text")->group("View");
    app.add_flag("--no-ground", texts.no_ground, "draw no grid at z = 0")->group("View");
}

void add_server(CLI::App& app, ViewerOptions& options, Texts& texts)
{
    app.add_option("--server", options.link.server, "name of the server; default: the only one")->type_name("NAME")->group("Server");
    app.add_option("--domain", options.link.domain.id, "DDS domain")->check(CLI::Range(0, 232))->group("Server");
    app.add_option("--interface", options.link.domain.network_interface, "network interface; default: this host only")
        ->type_name("NAME")
        ->group("Server");
    app.add_option("--timeout", texts.timeout, "maximum wait for the server, and for its next state; default: 10")
        ->check(link::check_positive)
        ->type_name("S")
        ->group("Server");
}

Result<void> take_vectors(const Texts& texts, ViewChoice& view)
{
    for (const auto& [name, text, target] :
         {std::tuple("--from", &texts.from, &view.from), std::tuple("--look-at", &texts.look_at, &view.look_at),
          std::tuple("--up", &texts.up, &view.up)})
    {
        if (text->empty()) continue;
        const auto vector = parse_vector(*text);
        if (!vector) return reason(std::string(name) + ": " + vector.error().reason);
        *target = *vector;
    }
    if (view.up && length(*view.up) == 0) return reason("--up must not be zero");
    return {};
}

Result<void> take_shots(const Texts& texts, ViewerOptions& options)
{
    if (!texts.png.empty()) options.shots.push_back({options.at, {}, texts.png});
    for (const std::string& text : texts.shots)
    {
        auto shot = parse_shot(text);
        if (!shot) return shot.errors();
        options.shots.push_back(shot.take());
    }
    // "Now" is before any time that is asked for.
    std::stable_sort(options.shots.begin(), options.shots.end(),
                     [](const Shot& a, const Shot& b) { return a.at.value_or(-1) < b.at.value_or(-1); });
    return {};
}

Result<void> take_task(const Texts& texts, ViewerOptions& options)
{
    if (auto shots = take_shots(texts, options); !shots) return shots;
    const int tasks = int(!options.shots.empty()) + int(!texts.frames.empty()) + int(!texts.film.empty());
    if (tasks == 0) return reason("needs an output: --png, --shot, --frames or --mp4; see plab-view --help");
    if (tasks > 1) return reason("makes pictures, frames or a film, only one of them per run");
    options.task = !texts.frames.empty() ? Task::Frames : !texts.film.empty() ? Task::Film : Task::Shots;
    options.target = options.task == Task::Frames ? texts.frames : texts.film;
    if (options.task == Task::Shots && (options.duration || options.until))
        return reason("--duration and --until require --frames or --mp4");
    if (options.task == Task::Shots && options.rate != 1) return reason("--rate requires --frames or --mp4");
    if (options.task == Task::Shots && texts.png.empty() && options.at) return reason("--at requires --png, --frames or --mp4");
    if (options.at && options.until && *options.until < *options.at) return reason("--until is before --at");
    return {};
}

}  // namespace

Result<Vec3> parse_vector(const std::string& text)
{
    std::string blanks = text;
    std::replace(blanks.begin(), blanks.end(), ',', ' ');
    std::istringstream words(blanks);
    std::vector<double> numbers;
    for (std::string word; words >> word;)
    {
        const auto number = parse_number(word);
        if (!number || !std::isfinite(*number)) return reason("'" + word + "' is not a number");
        numbers.push_back(*number);
    }
    if (numbers.size() != 3) return reason("needs three numbers, \"x y z\", not '" + text + "'");
    return Vec3{numbers[0], numbers[1], numbers[2]};
}

Result<Shot> parse_shot(const std::string& text)
{
    const std::size_t equal = text.find('=');
    const std::string when = text.substr(0, equal);
    const std::size_t sign = when.find('@');
    const auto time = parse_number(std::string_view(when).substr(0, sign));
    const bool named = sign != std::string::npos;
    if (equal == std::string::npos || equal + 1 == text.size() || !time || !link::check_not_negative(when.substr(0, sign)).empty() ||
        (named && sign + 1 == when.size()))
        return reason("--shot needs T[@CAMERA]=FILE, not '" + text + "'");
    return Shot{time, named ? when.substr(sign + 1) : "", text.substr(equal + 1)};
}

std::optional<ParseEnd> parse_options(int argc, const char* const* argv, ViewerOptions& options)
{
    auto environment = link::options_from_environment();
    if (!environment) return ParseEnd{2, "plab-view: " + environment.error().reason + "\n"};
    options.link = environment.take();
    CLI::App app{"plab-view: makes pictures of a running scene or a recording", "plab-view"};
    app.footer(kExamples);
    app.set_version_flag("--version", std::string("plab-view ") + PLAB_VERSION);
    Texts texts;
    add_pictures(app, options, texts);
    add_view(app, options, texts);
    add_server(app, options, texts);
    const auto values = [&](const program::Wanted& wanted) { return completion::common_values(wanted, options.link); };
    if (auto end = program::parse_command_line(app, argc, argv, PLAB_VERSION, values)) return end;
    if (texts.timeout) options.timeout = link::Seconds(*texts.timeout);
    options.captions = !texts.no_captions, options.ground = !texts.no_ground;
    if (!options.link.server.empty() && !wire::is_server_name(options.link.server))
        return ParseEnd{
            2, "plab-view: '" + options.link.server + "' is not a valid server name: use 1 to 64 letters, digits, '.', '_' or '-'\n"};
    for (const auto& taken : {take_vectors(texts, options.view), take_task(texts, options)})
        if (!taken) return ParseEnd{2, "plab-view: " + taken.error().reason + "\n"};
    return {};
}

}  // namespace plab::view
