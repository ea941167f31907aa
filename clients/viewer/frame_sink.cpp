#include "viewer/frame_sink.h"

#include <cstdio>
#include <filesystem>

#include "viewer/film.h"

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

}  // namespace plab::view
