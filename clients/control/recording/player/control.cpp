#include "control/recording/player/control.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cmath>

#include "control/recording/player/pace.h"
#include "link/numbers.h"

namespace plab::player
{

Result<ControlCommand> parse_control(const std::string& line)
{
    using Kind = ControlCommand::Kind;
    const std::size_t space = line.find(' ');
    const std::string word = line.substr(0, space), argument = space == std::string::npos ? "" : line.substr(space + 1);
    if (argument.empty() && word == "pause") return ControlCommand{Kind::Pause};
    if (argument.empty() && word == "resume") return ControlCommand{Kind::Resume};
    if (argument.empty() && word == "end") return ControlCommand{Kind::End};
    if (word == "rate" && link::check_positive(argument).empty())
        if (const double rate = std::stod(argument); rate >= Pace::kSlowest && rate <= Pace::kFastest)
            return ControlCommand{Kind::Rate, rate};
    constexpr double kLast = 9e9;  // s; in ns it still fits 64 bits
    if (word == "seek" && link::check_not_negative(argument).empty())
        if (const double seconds = std::stod(argument); seconds <= kLast) return ControlCommand{Kind::Seek, seconds};
    return reason("'" + line + "' is no command: use pause, resume, rate 0.001 to 1000, seek SECONDS, or end");
}

std::vector<Result<ControlCommand>> ControlLines::take(std::string_view bytes)
{
    std::vector<Result<ControlCommand>> out;
    for (const char c : bytes)
    {
        if (c != '\n')
        {
            is_too_long_ = is_too_long_ || rest_.size() >= kMostLine;
            if (!is_too_long_) rest_ += c;
            continue;
        }
        if (is_too_long_)
            out.emplace_back(reason("a line of more than " + std::to_string(kMostLine) + " bytes is no command"));
        else
            out.push_back(parse_control(rest_));
        rest_.clear(), is_too_long_ = false;
    }
    return out;
}

std::string ControlInput::read()
{
    std::array<char, 1024> bytes{};
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (is_closed_ || poll(&input, 1, 0) <= 0) return {};
    const ssize_t got = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    is_closed_ = got <= 0;
    return got > 0 ? std::string(bytes.data(), static_cast<std::size_t>(got)) : std::string();
}

}  // namespace plab::player
