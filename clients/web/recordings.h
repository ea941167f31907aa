/// The folder of recordings: the only place that pages write to. A name is that of a file in it, without ".mcap"; it can name nothing else.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "plab/result.h"

namespace plab::web
{

struct Recording
{
    std::string name;
    std::uint64_t bytes = 0;
    std::int64_t changed_ms = 0;    ///< since 1970
    std::optional<double> seconds;  ///< simulated; nothing: not known yet, or the file was not closed
    bool is_closed = false;
    bool operator==(const Recording&) const = default;
};

class Recordings
{
public:
    static constexpr std::size_t kMostShown = 200;  ///< the newest

    /// The folder is made if it is missing. An error: it cannot be made, or written to.
    static Result<Recordings> open(const std::string& folder, std::uint64_t most_bytes);

    /// Reads the folder again; the length of a file that has changed is read once, a few files at a time.
    void update();
    const std::vector<Recording>& list() const { return list_; }
    std::uint64_t bytes() const { return bytes_; }  ///< of all recordings
    std::uint64_t most_bytes() const { return most_bytes_; }
    const std::string& folder() const { return folder_; }

    /// Where a recording of this name is, or would be. An error: it is no name of a recording.
    Result<std::string> path_of(const std::string& name) const;
    bool has(const std::string& name) const;
    Result<void> remove(const std::string& name);

private:
    Recordings(std::string folder, std::uint64_t most_bytes) : folder_(std::move(folder)), most_bytes_(most_bytes) {}

    std::string folder_;
    std::uint64_t most_bytes_ = 0, bytes_ = 0;
    std::vector<Recording> list_;             ///< the newest first
    std::map<std::string, Recording> known_;  ///< with its length
};

}  // namespace plab::web
