#include "web/recordings.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <utility>

#include "idl/recording/reader.h"
#include "idl/values/limits.h"

namespace plab::web
{
namespace
{

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".mcap";
constexpr std::size_t kMostFiles = 10'000;                ///< of the folder, that are looked at
constexpr std::chrono::milliseconds kLongestReading(30);  ///< of lengths, at a time

/// A closed file ends as it begins. One that was cut would have to be read as a whole to know its length.
bool is_closed(const std::string& path, std::uint64_t bytes)
{
    constexpr std::array<char, 8> kMagic{'\x89', 'M', 'C', 'A', 'P', '0', '\r', '\n'};
    std::array<char, 8> end{};
    std::ifstream in(path, std::ios::binary);
    if (bytes < 2 * kMagic.size()) return false;
    in.seekg(static_cast<std::streamoff>(bytes - end.size())).read(end.data(), end.size());
    return in && end == kMagic;
}

std::optional<double> length_of(const std::string& path)
{
    const auto reader = recording::McapReader::open(path);
    if (!reader) return {};
    const recording::FileIndex& index = reader->index();
    if (index.chunks.empty()) return 0.0;
    return static_cast<double>(index.latest_before.back() - index.chunks.front().start_time) * 1e-9;
}

/// What the system says of a file; nothing: it is no regular file (a link is none).
std::optional<Recording> facts_of(const std::string& path, std::string name)
{
    struct stat facts
    {
    };
    if (lstat(path.c_str(), &facts) != 0 || !S_ISREG(facts.st_mode)) return {};
    Recording out;
    out.name = std::move(name), out.bytes = static_cast<std::uint64_t>(facts.st_size);
    out.changed_ms = static_cast<std::int64_t>(facts.st_mtim.tv_sec) * 1000 + facts.st_mtim.tv_nsec / 1'000'000;
    return out;
}

}  // namespace

Result<Recordings> Recordings::open(const std::string& folder, std::uint64_t most_bytes)
{
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder, error)) return reason("'" + folder + "' is no folder, and cannot be made one");
    if (access(folder.c_str(), W_OK | X_OK) != 0) return reason("nothing may be written to the folder '" + folder + "'");
    Recordings out(fs::canonical(folder, error).string(), most_bytes);
    out.update();
    return out;
}

void Recordings::update()
{
    const auto end = std::chrono::steady_clock::now() + kLongestReading;
    std::error_code error;
    std::size_t seen = 0;
    std::map<std::string, Recording> now;
    bytes_ = 0;
    for (fs::directory_iterator at(folder_, error), last; !error && at != last && ++seen <= kMostFiles; at.increment(error))
    {
        const std::string file = at->path().filename().string();
        if (!file.ends_with(kEnding)) continue;
        const std::string name = file.substr(0, file.size() - kEnding.size());
        auto facts = path_of(name) ? facts_of(at->path().string(), name) : std::nullopt;
        if (!facts) continue;
        bytes_ += facts->bytes;
        const auto known = known_.find(name);
        const bool is_same = known != known_.end() && known->second.bytes == facts->bytes && known->second.changed_ms == facts->changed_ms;
        if (is_same) facts->seconds = known->second.seconds, facts->is_closed = known->second.is_closed;
        if (!is_same) facts->is_closed = is_closed(at->path().string(), facts->bytes);
        if (facts->is_closed && !facts->seconds && std::chrono::steady_clock::now() < end)
        {
            facts->seconds = length_of(at->path().string());
            facts->is_closed = facts->seconds.has_value();  // a damaged one is not tried again
        }
        now.emplace(name, *facts);
    }
    known_ = std::move(now);
    list_.clear();
    for (const auto& [name, recording] : known_) list_.push_back(recording);
    std::stable_sort(list_.begin(), list_.end(), [](const Recording& a, const Recording& b) { return a.changed_ms > b.changed_ms; });
    if (list_.size() > kMostShown) list_.resize(kMostShown);
}

Result<std::string> Recordings::path_of(const std::string& name) const
{
    if (!wire::is_server_name(name) || name.front() == '.' || name.front() == '-')
        return reason("'" + name.substr(0, 80) +
                      "' is no name of a recording: use 1 to 64 letters, digits, '.', '_' or '-', beginning with a letter, a digit or '_'");
    return folder_ + "/" + name + std::string(kEnding);
}

bool Recordings::has(const std::string& name) const
{
    const auto path = path_of(name);
    return path && facts_of(*path, name).has_value();
}

Result<void> Recordings::remove(const std::string& name)
{
    const auto path = path_of(name);
    if (!path) return path.errors();
    if (!has(name)) return reason("there is no recording '" + name + "'");
    std::error_code error;
    if (!fs::remove(*path, error)) return reason("'" + name + "' cannot be deleted: " + error.message());
    return {};
}

}  // namespace plab::web
