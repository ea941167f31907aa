/// How far the work has come: a bar on standard error where that is a terminal and the work is long; one line at the end.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace plab::view
{

class Progress
{
public:
    /// `what` is counted ("frames"); `total`, where it is known.
    explicit Progress(std::string what);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void update(std::uint64_t done, std::optional<std::uint64_t> total, double time);
    /// A message of its own line.
    void say(const std::string& message);
    /// "8 frames, 1.2 s"
    void finish(std::uint64_t done);

private:
    void clear();

    std::string what_;
    bool terminal_, shown_ = false;
    std::chrono::steady_clock::time_point start_, next_;
};

/// "[#####.....]  50 %", for a width in characters.
std::string bar(std::uint64_t done, std::uint64_t total, std::size_t width);

}  // namespace plab::view
