#include "idl/recording/format.h"

#include <array>
#include <charconv>
#include <cstdio>

namespace plab::recording
{
namespace
{

std::string value_in(const Pairs& values, const char* key)
{
    const auto found = values.find(key);
    return found == values.end() ? std::string() : found->second;
}

std::string number(double value)
{
    std::array<char, 32> text{};
    (void)std::snprintf(text.data(), text.size(), "%.17g", value);
    return text.data();
}

std::string joined(const std::vector<std::string>& words)
{
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
    return out;
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

Metadata about(const Origin& o)
{
    Metadata out{kAbout, {}};
    out.values = {{"format", std::to_string(kFormat)},
                  {"recorder", o.recorder},
                  {"server", o.server},
                  {"version", o.version},
                  {"host", o.host},
                  {"started_ns", std::to_string(o.started_ns)},
                  {"scene_file", o.scene_file},
                  {"dt", number(o.dt)},
                  {"threads", std::to_string(o.threads)},
                  {"state_interval", number(o.state_interval)},
                  {"states", o.moved_only ? "moved" : "all"}};
    if (!o.build.empty()) out.values["build"] = o.build;
    if (!o.topics.empty()) out.values["topics"] = joined(o.topics);
    return out;
}

Result<McapReader> open_recording(const std::string& path, const Watch& watch)
{
    auto file = FileSource::open(path);
    if (!file) return file.errors();
    std::unique_ptr<const Source> source = std::make_unique<FileSource>(file.take());
    if (watch) source = std::make_unique<WatchedSource>(std::move(source), watch);
    auto reader = McapReader::open(std::move(source));
    if (!reader) return reader;
    // Missing or damaged: the rest of the file may still be intact.
    const auto about = reader->metadata(kAbout);
    if (!about) return reader;
    if (const std::string why = why_not(about->values); !why.empty()) return reason(reader->name() + ": " + why);
    return reader;
}

}  // namespace plab::recording
