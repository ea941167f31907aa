#include "idl/recording/format.h"

#include <charconv>

namespace plab::recording
{
namespace
{

std::string value_in(const Pairs& values, const char* key)
{
    const auto found = values.find(key);
    return found == values.end() ? std::string() : found->second;
}

/// The reason why this build cannot understand the file; "" if it can.
std::string why_not(const Pairs& about)
{
    const std::string text = value_in(about, "format"), version = value_in(about, "version");
    const std::string reads = "this build reads format " + std::to_string(kFormat);
    int format = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), format);
    if (error != std::errc() || end != text.data() + text.size() || format < 1)
        return text.empty() ? "does not state its format; " + reads : "has the unknown format '" + text + "'; " + reads;
    if (format >= kOldestFormat && format <= kFormat) return {};
    return "is of format " + text + ", " + reads + ": " + (format > kFormat ? "a newer" : "an older") + " pLab" +
           (version.empty() ? "" : ", " + version + ",") + " wrote it, and one like that reads it";
}

}  // namespace

Result<Reader> open_recording(const std::string& path, const Watch& watch)
{
    auto file = FileSource::open(path);
    if (!file) return file.errors();
    std::unique_ptr<const Source> source = std::make_unique<FileSource>(file.take());
    if (watch) source = std::make_unique<WatchedSource>(std::move(source), watch);
    auto reader = Reader::open(std::move(source));
    if (!reader) return reader;
    // Missing or damaged: the rest of the file may still be intact.
    const auto about = reader->metadata(kAbout);
    if (!about) return reader;
    if (const std::string why = why_not(about->values); !why.empty()) return reason(reader->name() + ": " + why);
    return reader;
}

}  // namespace plab::recording
