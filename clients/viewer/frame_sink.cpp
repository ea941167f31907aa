#include "viewer/frame_sink.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <thread>

namespace plab::view
{
namespace
{

class Folder : public FrameSink
{
public:
    explicit Folder(std::string path) : path_(std::move(path)) {}
    Result<void> add(std::uint64_t index, const render::Picture& picture) override
    {
        char name[40];
        std::snprintf(name, sizeof name, "/frame_%04llu.png", static_cast<unsigned long long>(index));
        return picture::write_png(path_ + name, picture);
    }
    Result<void> finish() override { return {}; }

private:
    std::string path_;
};

class FilmSink : public FrameSink
{
public:
    explicit FilmSink(Film film) : film_(std::move(film)) {}
    Result<void> add(std::uint64_t, const render::Picture& picture) override { return film_.add(picture); }
    Result<void> finish() override { return film_.finish(); }

private:
    Film film_;
};

Result<std::unique_ptr<FrameSink>> open_film(const ViewerOptions& options)
{
    auto ffmpeg = find_ffmpeg();
    if (!ffmpeg) return ffmpeg.errors();
    auto film = Film::open(*ffmpeg, options.target, options.width, options.height, options.frames_per_second);
    if (!film) return film.errors();
    return std::unique_ptr<FrameSink>(std::make_unique<FilmSink>(film.take()));
}

}  // namespace

Result<std::unique_ptr<FrameSink>> open_frame_sink(const ViewerOptions& options)
{
    if (options.task == Task::Film) return open_film(options);
    std::error_code error;
    std::filesystem::create_directories(options.target, error);
    if (error) return reason("cannot make the folder '" + options.target + "': " + error.message());
    return std::unique_ptr<FrameSink>(std::make_unique<Folder>(options.target));
}

namespace
{

constexpr auto kLongestEnding = std::chrono::seconds(60);

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

std::vector<std::string> command_of(const std::string& ffmpeg, const std::string& file, std::uint32_t width, std::uint32_t height,
                                    double frames_per_second)
{
    return {ffmpeg, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba",
            // clang-format off
            "-s", std::to_string(width) + "x" + std::to_string(height), "-r", number(frames_per_second), "-i", "-",
            // yuv420p needs even sizes.
            "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-preset", "veryfast", "-crf", "20", "-pix_fmt", "yuv420p",
            "-movflags", "+faststart", "-f", "mp4", file};
    // clang-format on
}

/// How ffmpeg is started: our pipe as its input, no blocked signals, and detached from the terminal's Ctrl-C, which would
/// truncate the film.
class SpawnSettings
{
public:
    explicit SpawnSettings(int input)
    {
        (void)posix_spawn_file_actions_init(&actions_);
        (void)posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
        (void)posix_spawnattr_init(&attributes_);
        sigset_t none;
        (void)sigemptyset(&none);
        (void)posix_spawnattr_setsigmask(&attributes_, &none);
        sigset_t usual;
        (void)sigemptyset(&usual);
        for (const int ignored : {SIGPIPE, SIGXFSZ}) (void)sigaddset(&usual, ignored);
        (void)posix_spawnattr_setsigdefault(&attributes_, &usual);
        (void)posix_spawnattr_setpgroup(&attributes_, 0);
        (void)posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;
    ~SpawnSettings()
    {
        (void)posix_spawn_file_actions_destroy(&actions_);
        (void)posix_spawnattr_destroy(&attributes_);
    }
    int spawn(pid_t& process, std::vector<char*>& arguments) const
    {
        return posix_spawn(&process, arguments.front(), &actions_, &attributes_, arguments.data(), environ);
    }

private:
    posix_spawn_file_actions_t actions_;
    posix_spawnattr_t attributes_;
};

}  // namespace

Result<std::string> find_ffmpeg()
{
    const char* const path = std::getenv("PATH");
    const std::string folders = path != nullptr ? path : "";
    for (std::size_t begin = 0; begin < folders.size();)
    {
        const std::size_t end = std::min(folders.find(':', begin), folders.size());
        const std::string candidate = folders.substr(begin, end - begin) + "/ffmpeg";
        if (access(candidate.c_str(), X_OK) == 0) return candidate;
        begin = end + 1;
    }
    return reason("a film needs ffmpeg, which is not in PATH: install it, or write pictures with --frames");
}

Result<Film> Film::open(const std::string& ffmpeg, const std::string& file, std::uint32_t width, std::uint32_t height,
                        double frames_per_second)
{
    Film film(file, file + ".part");
    if (auto started = film.start(command_of(ffmpeg, film.partial_, width, height, frames_per_second)); !started) return started.errors();
    return film;
}

Result<void> Film::start(const std::vector<std::string>& command)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return reason(std::string("cannot make a pipe to ffmpeg: ") + std::strerror(errno));
    pipe_ = ends[1];
    std::vector<std::string> texts(command);
    std::vector<char*> arguments;
    for (std::string& text : texts) arguments.push_back(text.data());
    arguments.push_back(nullptr);
    const int error = SpawnSettings(ends[0]).spawn(process_, arguments);
    (void)::close(ends[0]);
    if (error == 0) return {};
    process_ = -1;
    return reason(std::string("cannot start ffmpeg: ") + std::strerror(error));
}

Film::Film(Film&& other) noexcept
    : file_(std::move(other.file_)),
      partial_(std::move(other.partial_)),
      pipe_(std::exchange(other.pipe_, -1)),
      process_(std::exchange(other.process_, -1))
{
}

Film::~Film()
{
    if (process_ >= 0)
    {
        (void)wait();
        std::error_code ignored;
        (void)std::filesystem::remove(partial_, ignored);
    }
    close_pipe();
}

Result<void> Film::add(const render::Picture& picture)
{
    const std::uint8_t* data = picture.rgba.data();
    std::size_t left = picture.rgba.size();
    while (left > 0)
    {
        const ssize_t written = ::write(pipe_, data, left);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return reason(std::string("ffmpeg accepts no more pictures: ") + std::strerror(errno));
        data += written, left -= static_cast<std::size_t>(written);
    }
    return {};
}

void Film::close_pipe()
{
    if (pipe_ >= 0) (void)::close(pipe_);
    pipe_ = -1;
}

std::optional<int> Film::wait()
{
    close_pipe();
    const auto end = std::chrono::steady_clock::now() + kLongestEnding;
    int status = 0;
    while (waitpid(process_, &status, WNOHANG) == 0)
    {
        if (std::chrono::steady_clock::now() < end)
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            continue;
        }
        (void)::kill(process_, SIGKILL);
        (void)waitpid(process_, &status, 0);
        break;
    }
    process_ = -1;
    return WIFEXITED(status) ? std::optional(WEXITSTATUS(status)) : std::nullopt;
}

Result<void> Film::finish()
{
    const std::optional<int> status = wait();
    std::error_code error;
    if (status == 0) std::filesystem::rename(partial_, file_, error);
    if (status == 0 && !error) return {};
    std::error_code ignored;
    (void)std::filesystem::remove(partial_, ignored);
    if (status == 0) return reason("cannot write '" + file_ + "': " + error.message());
    return reason("ffmpeg failed" + (status ? " with exit code " + std::to_string(*status) : std::string(": it was killed")) + ", '" +
                  file_ + "' is not written");
}

}  // namespace plab::view
