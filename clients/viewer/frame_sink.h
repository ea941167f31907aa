/// The destination of the frames of a sequence: numbered files, or a film.
#pragma once

#include <sys/types.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/render.h"
#include "viewer/options.h"

namespace plab::view
{

/// The path of ffmpeg, or an error if it is not in PATH.
Result<std::string> find_ffmpeg();

/// A film: raw pictures through a pipe to ffmpeg.
class Film
{
public:
    /// Starts ffmpeg. The file gets its name only when finish() has succeeded.
    static Result<Film> open(const std::string& ffmpeg, const std::string& file, std::uint32_t width, std::uint32_t height,
                             double frames_per_second);
    Film(Film&& other) noexcept;
    Film& operator=(Film&&) = delete;
    /// Without finish(): discards the film.
    ~Film();

    Result<void> add(const render::Picture& picture);
    Result<void> finish();

private:
    Film(std::string file, std::string partial) : file_(std::move(file)), partial_(std::move(partial)) {}
    Result<void> start(const std::vector<std::string>& command);
    void close_pipe();
    /// Exit status of ffmpeg after its input was closed; empty if it did not end by itself.
    std::optional<int> wait();

    std::string file_, partial_;
    int pipe_ = -1;
    pid_t process_ = -1;
};

class FrameSink
{
public:
    virtual ~FrameSink() = default;
    virtual Result<void> add(std::uint64_t index, const render::Picture& picture) = 0;
    /// No more frames follow. A sink that is not finished leaves no partial film behind.
    virtual Result<void> finish() = 0;
};

/// For Task::Frames and Task::Film: makes the folder, or starts ffmpeg.
Result<std::unique_ptr<FrameSink>> open_frame_sink(const ViewerOptions& options);

}  // namespace plab::view
