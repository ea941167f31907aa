/// A playback that another program controls, by lines on standard input:
///
///   pause | resume | rate R | seek SECONDS | end
///
/// SECONDS are of the recording's time line. When the input is closed, the playback ends.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plab/result.h"

namespace plab::player
{

struct ControlCommand
{
    enum class Kind : unsigned char
    {
        Pause,
        Resume,
        Rate,  ///< value: seconds of the recording per second
        Seek,  ///< value: s
        End,
    };
    Kind kind = Kind::Pause;
    double value = 0;
};

/// An error quotes the line.
Result<ControlCommand> parse_control(const std::string& line);

/// Divides what arrives into commands. A line of more than kMostLine bytes is an error, and skipped.
class ControlLines
{
public:
    static constexpr std::size_t kMostLine = 256;
    std::vector<Result<ControlCommand>> take(std::string_view bytes);

private:
    std::string rest_;
    bool is_too_long_ = false;
};

/// What waits on standard input.
class ControlInput
{
public:
    /// Never waits.
    std::string read();
    bool is_closed() const { return is_closed_; }

private:
    bool is_closed_ = false;
};

}  // namespace plab::player
