/// The components in a recording: objects by the handles that frames use, interactions and their algorithms.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "control/recordings/stream.h"

namespace plab::recordings
{

struct Thing
{
    std::string id;
    bool is_shaft = false;
    std::string motion;
};

/// An interaction whose algorithm changed at `step`.
struct Change
{
    std::uint64_t run = 0;
    std::int64_t step = 0;
    std::uint64_t log_time = 0;
    std::string component, from, to;
};

class Things
{
public:
    void note(const Entry& entry);

    /// Its id; "#7" if the recording does not contain it.
    std::string name_of(std::uint64_t run, std::uint32_t handle) const;
    /// Null if the recording does not contain it.
    const Thing* find(std::uint64_t run, std::uint32_t handle) const;
    /// Empty: that run has no such object. "#7" is the one whose handle is 7.
    std::optional<std::uint32_t> handle_of(std::uint64_t run, const std::string& id) const;
    bool has_objects() const { return !objects_.empty(); }
    bool is_shaft(const std::string& id) const;
    /// Ids of all objects, of any run, sorted.
    std::vector<std::string> objects() const;
    /// Ids of all interactions, of any run, sorted.
    std::vector<std::string> interactions() const;
    /// In the order of the recording.
    const std::vector<Change>& changes() const { return changes_; }

private:
    struct Algorithm
    {
        std::uint64_t run = 0;
        std::string type;
    };
    void note(const plab_v2_Interaction& interaction, std::uint64_t log_time);

    std::map<std::pair<std::uint64_t, std::uint32_t>, Thing> objects_;  ///< by run and handle
    std::map<std::string, Algorithm> algorithms_;                       ///< newest, by interaction
    std::vector<Change> changes_;
};

}  // namespace plab::recordings
