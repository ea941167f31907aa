// plab-view as its user sees it, against a server that plays a script.
#include <doctest/doctest.h>
#include <png.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "support/text.h"
#include "viewer/fake_server.h"

namespace
{

using namespace plab;
using plab::test::has;
using test::FakeServer;
using test::quoted;
using test::Script;

/// Tests have a domain of their own, on this host, whatever the user's environment.
const bool environment_set = setenv("PLAB_DOMAIN", "57", 1) == 0 && unsetenv("CYCLONEDDS_URI") == 0 && unsetenv("PLAB_INTERFACE") == 0 &&
                             unsetenv("PLAB_SERVER") == 0;

struct Run
{
    int code = -1;
    std::string text;
};

/// `before`: assignments of the environment and other words in front of the command.
Run view(const std::string& arguments, const std::string& before = {})
{
    const std::string command = before + " " + quoted(std::string(PLAB_BINARY_DIR) + "/bin/plab-view") + " " + arguments + " 2>&1";
    std::FILE* const pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    Run out;
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) out.text.append(buffer, n);
    const int status = pclose(pipe);
    out.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    return out;
}

Run view(const FakeServer& server, const std::string& arguments)
{
    return view(arguments + " --width 320 --height 240 --timeout 5 --server " + server.name());
}

/// An empty folder of this test's own.
class Folder
{
public:
    explicit Folder(const std::string& name) : path_(std::string(PLAB_BINARY_DIR) + "/viewer_test_" + name + "_" + std::to_string(getpid()))
    {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string operator/(const std::string& name) const { return path_ + "/" + name; }
    std::size_t files() const
    {
        std::size_t n = 0;
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path_)) ++n;
        return n;
    }

private:
    std::string path_;
};

struct Pixels
{
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

Pixels read_png(const std::string& file)
{
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    REQUIRE_MESSAGE(png_image_begin_read_from_file(&image, file.c_str()) != 0, file);
    image.format = PNG_FORMAT_RGBA;
    Pixels out{static_cast<int>(image.width), static_cast<int>(image.height), std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
    REQUIRE(png_image_finish_read(&image, nullptr, out.rgba.data(), 0, nullptr) != 0);
    return out;
}

struct Patch
{
    int count = 0;
    double x = 0, y = 0;  ///< middle, pixels from the top left
};

/// Pixels in which one channel (0 red, 1 green) is far above the others.
Patch find_colour(const Pixels& picture, int channel)
{
    Patch out;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
        {
            const std::uint8_t* const p = &picture.rgba[static_cast<std::size_t>(4 * (y * picture.width + x))];
            const int other = std::max<int>({channel == 0 ? 0 : int(p[0]), channel == 1 ? 0 : int(p[1]), int(p[2])});
            if (p[channel] < 60 || p[channel] < 2 * other) continue;
            ++out.count, out.x += x, out.y += y;
        }
    if (out.count > 0) out.x /= out.count, out.y /= out.count;
    return out;
}

/// Row at which the front camera of the script (8 m in front of and 2 m above the origin, looking at 1.5 m) sees the
/// height z above the origin.
double row_of_height(double z, int height)
{
    const double distance = std::sqrt(8.0 * 8 + 0.5 * 0.5);
    const double forward_y = 8 / distance, forward_z = -0.5 / distance;
    const double depth = 8 * forward_y + (z - 2) * forward_z;
    const double up = 8 * -forward_z + (z - 2) * forward_y;
    return height / 2.0 * (1 - up / depth / std::tan(0.35));
}

/// The time of this picture that the program prints, s.
double time_of(const std::string& text, const std::string& picture)
{
    const std::string lead = picture + ": t = ";
    const std::size_t at = text.find(lead);
    REQUIRE_MESSAGE(at != std::string::npos, text);
    return std::atof(text.c_str() + at + lead.size());
}

}  // namespace

TEST_CASE("pictures at named times show the ball where it falls")
{
    FakeServer server({});
    Folder folder("shots");
    const Run run = view(server, "--no-captions --shot 0=" + quoted(folder / "a.png") + " --shot 0.4=" + quoted(folder / "b.png") +
                                     " --shot 0.2@behind=" + quoted(folder / "c.png"));
    REQUIRE_MESSAGE(run.code == 0, run.text);
    CHECK(has(run.text, "a.png: t = 0.000 s, step 0\n"));
    // The first state at or after 0.4 s; on a busy machine that may be a later one, which is then reported.
    const double later = time_of(run.text, "b.png");
    CHECK(later >= 0.4);
    CHECK(later < 0.5);
    const Pixels a = read_png(folder / "a.png"), b = read_png(folder / "b.png"), c = read_png(folder / "c.png");
    CHECK(a.width == 320);
    CHECK(a.height == 240);
    for (const auto& [picture, time] : {std::pair(&a, 0.0), std::pair(&b, later), std::pair(&c, time_of(run.text, "c.png"))})
    {
        const Patch ball = find_colour(*picture, 0);
        CHECK(ball.count > 300);
        CHECK(std::abs(ball.x - 160) < 3);
        CHECK(std::abs(ball.y - row_of_height(test::height_at(time), 240)) < 4);
    }
}

TEST_CASE("frames at equal simulated times, interpolated between the states")
{
    FakeServer server({});
    Folder folder("frames");
    // States come every 4/240 s: at 25 frames per second most frames lie between two states.
    const Run run = view(server, "--no-captions --at 0 --fps 25 --duration 0.2 --frames " + quoted(folder / "out"));
    REQUIRE_MESSAGE(run.code == 0, run.text);
    CHECK(has(run.text, "5 frames, "));
    for (int i = 0; i < 5; ++i)
    {
        const Patch ball = find_colour(read_png(folder / ("out/frame_000" + std::to_string(i) + ".png")), 0);
        CHECK(std::abs(ball.y - row_of_height(test::height_at(0.04 * i), 240)) < 4);
    }
    CHECK_FALSE(std::filesystem::exists(folder / "out/frame_0005.png"));
}

TEST_CASE("frames that cannot be made are reported, also by the exit code")
{
    Folder folder("missing");
    {
        FakeServer server({.first_time = 0.3, .until = 0.6});
        const Run run = view(server, "--at 0 --fps 10 --duration 0.5 --frames " + quoted(folder / "early"));
        CHECK(run.code == 1);
        CHECK_MESSAGE(has(run.text, "the first 3 frames cannot be made"), run.text);
        CHECK_FALSE(std::filesystem::exists(folder / "early/frame_0002.png"));
        CHECK(std::filesystem::exists(folder / "early/frame_0003.png"));
    }
    {
        FakeServer server({.until = 0.3, .leaves = true});
        const Run run = view(server, "--at 0 --fps 10 --duration 0.5 --frames " + quoted(folder / "late"));
        CHECK(run.code == 1);
        const bool reported =
            has(run.text, "the server has gone; ") && has(run.text, " of 5 frames cannot be made, the last state was of t = 0.");
        CHECK_MESSAGE(reported, run.text);
        CHECK(std::filesystem::exists(folder / "late/frame_0000.png"));
        CHECK_FALSE(std::filesystem::exists(folder / "late/frame_0004.png"));
    }
}

TEST_CASE("an object that is in the states before it is in the catalogue is skipped, then drawn")
{
    FakeServer server({.until = 1, .late_at = 24});
    Folder folder("late");
    const Run run =
        view(server, "--no-captions --shot 0.12=" + quoted(folder / "before.png") + " --shot 0.9=" + quoted(folder / "after.png"));
    REQUIRE_MESSAGE(run.code == 0, run.text);
    CHECK(find_colour(read_png(folder / "before.png"), 1).count == 0);
    CHECK(find_colour(read_png(folder / "after.png"), 1).count > 100);
}

TEST_CASE("a swap changes the caption at its step")
{
    // One step is one frame: the picture of step 48 differs from that of 44 in the caption alone, all else hidden.
    const auto caption_changes = [](std::int64_t swap_at)
    {
        FakeServer server({.until = 0.6, .swap_at = swap_at});
        Folder folder("swap" + std::to_string(swap_at));
        const std::string nothing = " --no-ground --from '0 0 100' --look-at '0 0 200' --up '0 1 0'";
        const Run run = view(server, "--at 0 --fps 60 --duration 0.3 --frames " + quoted(folder / "out") + nothing);
        REQUIRE_MESSAGE(run.code == 0, run.text);
        std::vector<int> changes;
        const auto lines = [&](int i)
        {
            char name[40];
            std::snprintf(name, sizeof name, "out/frame_%04d.png", i);
            Pixels picture = read_png(folder / name);
            // Without the first line, which has the time.
            picture.rgba.erase(picture.rgba.begin(), picture.rgba.begin() + 4 * 320 * 26);
            return picture.rgba;
        };
        for (int i = 1; i < 18; ++i)
            if (lines(i) != lines(i - 1)) changes.push_back(4 * i);
        return changes;
    };
    CHECK(caption_changes(48) == std::vector<int>{48});
    CHECK(caption_changes(-1).empty());
}

TEST_CASE("a paused server that sends no states is drawn from its catalogue")
{
    FakeServer server({.paused = true});
    Folder folder("paused");
    const Run run = view(server, "--no-captions --png " + quoted(folder / "now.png"));
    REQUIRE_MESSAGE(run.code == 0, run.text);
    CHECK(std::abs(find_colour(read_png(folder / "now.png"), 0).y - row_of_height(3, 240)) < 4);
    const Run never = view("--timeout 1 --at 5 --png " + quoted(folder / "never.png") + " --server " + server.name());
    CHECK(never.code == 3);
    CHECK_MESSAGE(has(never.text, "no new state for 1 s: the server is paused at t = 0.000 s"), never.text);
    CHECK_FALSE(std::filesystem::exists(folder / "never.png"));
}

TEST_CASE("exit codes: no server 3, wrong use 2, what the scene does not have 1, no ffmpeg 1, interrupted 130")
{
    Folder folder("codes");
    const auto start = std::chrono::steady_clock::now();
    const Run none = view("--timeout 1 --server nobody --png " + quoted(folder / "a.png"));
    CHECK(none.code == 3);
    CHECK_MESSAGE(has(none.text, "nobody"), none.text);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
    CHECK(view("--server 'two words' --png a.png").code == 2);
    CHECK(view("--bogus").code == 2);

    const Run no_ffmpeg = view("--mp4 " + quoted(folder / "a.mp4"), "PATH=");
    CHECK(no_ffmpeg.code == 1);
    CHECK_MESSAGE(has(no_ffmpeg.text, "a film needs ffmpeg, which is not in PATH"), no_ffmpeg.text);

    FakeServer server({.until = 6000});
    const Run no_camera = view(server, "--camera top --png " + quoted(folder / "a.png"));
    CHECK(no_camera.code == 1);
    CHECK_MESSAGE(has(no_camera.text, "the scene has no camera 'top'; it has: behind, front"), no_camera.text);
    CHECK(view(server, "--track nobody --png " + quoted(folder / "a.png")).code == 1);
    const Run interrupted =
        view("--frames " + quoted(folder / "out") + " --timeout 30 --server " + server.name(), "timeout --preserve-status -k 8 -s INT 2");
    CHECK(interrupted.code == 130);
    CHECK_MESSAGE(has(interrupted.text, "interrupted"), interrupted.text);
    const Run terminated = view("--png " + quoted(folder / "late.png") + " --at 1e6 --timeout 30 --server " + server.name(),
                                "timeout --preserve-status -k 8 -s TERM 1");
    CHECK(terminated.code == 143);
    CHECK(folder.files() == 1);
}

TEST_CASE("a film has the requested frames")
{
    if (std::system("command -v ffmpeg > /dev/null && command -v ffprobe > /dev/null") != 0)
    {
        MESSAGE("skipped: there is no ffmpeg here");
        return;
    }
    FakeServer server({});
    Folder folder("film");
    const Run run = view("--at 0 --fps 20 --until 0.45 --width 321 --height 240 --orbit 8 --mp4 " + quoted(folder / "a.mp4") +
                         " --server " + server.name());
    REQUIRE_MESSAGE(run.code == 0, run.text);
    CHECK(has(run.text, "10 frames, "));
    const std::string probe =
        "test \"$(ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 " + quoted(folder / "a.mp4") + ")\" = 10";
    CHECK(std::system(probe.c_str()) == 0);
    CHECK(folder.files() == 1);
}

TEST_CASE("after a reset the film continues with the new run, and this is reported")
{
    FakeServer server({.until = 0.6, .reset_at = 48});
    Folder folder("reset");
    const Run run = view(server, "--no-captions --at 0 --fps 20 --duration 0.5 --frames " + quoted(folder / "out"));
    REQUIRE_MESSAGE(run.code == 0, run.text);
    CHECK_MESSAGE(has(run.text, "the scene was loaded or reset meanwhile"), run.text);
    // Frames 0 to 3 of the first run, up to t = 0.183; then from t = 0 again.
    CHECK(std::abs(find_colour(read_png(folder / "out/frame_0004.png"), 0).y - row_of_height(3, 240)) < 4);
}
