#include "control/recordings/words.h"

#include <array>
#include <ctime>

namespace plab::recordings
{

std::string text_at(const recording::Pairs& pairs, const std::string& key)
{
    const auto found = pairs.find(key);
    return found == pairs.end() ? std::string() : found->second;
}

std::string counted(std::uint64_t n, const std::string& what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); }

std::string date_text(std::uint64_t nanoseconds)
{
    const auto when = static_cast<std::time_t>(nanoseconds / 1'000'000'000);
    std::tm utc{};
    (void)gmtime_r(&when, &utc);
    std::array<char, 40> text{};
    (void)std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &utc);
    return text.data();
}

}  // namespace plab::recordings
