#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "picture/picture.h"

namespace plab::picture
{
namespace
{

struct Close
{
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

/// Level 3 takes half the time of the usual 6 and gives files that are a few per cent larger.
constexpr int kCompression = 3;

/// libpng leaves by longjmp on an error: this frame holds nothing that would have to be cleaned up.
bool encode(std::FILE* file, png_structp png, png_infop info, const Picture& picture)
{
    if (setjmp(png_jmpbuf(png))) return false;
    png_init_io(png, file);
    png_set_compression_level(png, kCompression);
    png_set_IHDR(png, info, picture.width, picture.height, 8, PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (std::uint32_t row = 0; row < picture.height; ++row) png_write_row(png, picture.rgba.data() + std::size_t{4} * picture.width * row);
    png_write_end(png, nullptr);
    return true;
}

bool encode(std::FILE* file, const Picture& picture)
{
    const auto quiet = [](png_structp, png_const_charp) {};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, quiet);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const bool done = info && encode(file, png, info, picture);
    png_destroy_write_struct(&png, &info);
    return done;
}

Result<void> write_to(const std::string& path, const Picture& picture)
{
    File file(std::fopen(path.c_str(), "wb"));
    if (!file) return reason("cannot write " + path + ": " + std::strerror(errno));
    if (!encode(file.get(), picture)) return reason("cannot write " + path + ": libpng failed; the disk may be full");
    if (std::fclose(file.release()) != 0) return reason("cannot write " + path + ": " + std::strerror(errno));
    return {};
}

}  // namespace

Result<void> write_png(const std::string& path, const Picture& picture)
{
    const std::size_t bytes = std::size_t{4} * picture.width * picture.height;
    if (bytes == 0 || picture.rgba.size() != bytes)
        return reason("a picture of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) + " pixels must have " +
                      std::to_string(bytes) + " bytes and at least one pixel, not " + std::to_string(picture.rgba.size()) + " bytes");
    const std::string beside = path + ".part";
    std::error_code ignored, failed;
    if (auto done = write_to(beside, picture); !done)
    {
        std::filesystem::remove(beside, ignored);
        return done;
    }
    std::filesystem::rename(beside, path, failed);
    if (!failed) return {};
    std::filesystem::remove(beside, ignored);
    return reason("cannot write " + path + ": " + failed.message());
}

}  // namespace plab::picture
