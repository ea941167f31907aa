#include "web/preview.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "link/text.h"

namespace plab::web
{
namespace
{

constexpr std::chrono::seconds kLongest(60);

std::vector<std::string> command_of(const link::SessionOptions& server, const PreviewAsk& ask)
{
    std::vector<std::string> out{program::program_beside("plabctl"), "--json", "--server", server.server, "--domain",
                                 std::to_string(server.domain.id)};
    if (!server.domain.network_interface.empty()) out.insert(out.end(), {"--interface", server.domain.network_interface});
    // No word begins with '-': parse_said() has refused those.
    out.insert(out.end(), {"shadow", ask.component, "--with", ask.type, "--for", link::number_text(ask.seconds)});
    return out;
}

}  // namespace

void Preview::start(const link::SessionOptions& server, const PreviewAsk& ask, Then then)
{
    if (child_) return then(reason("another preview is being made; try again"));
    auto child = program::Child::start(command_of(server, ask), program::Streams::Piped);
    if (!child) return then(child.errors());
    child_.emplace(child.take());
    printed_.clear();
    then_ = std::move(then);
    end_ = std::chrono::steady_clock::now() + kLongest;
}

void Preview::update()
{
    if (!child_) return;
    // First whether it has ended, then what it said: nothing comes after that.
    const std::optional<int> code = child_->exit_code();
    for (const std::string& line : child_->take_lines()) printed_ += line;
    if (!code)
    {
        if (std::chrono::steady_clock::now() >= end_) child_->ask_to_end();
        return;
    }
    std::string why = child_->complaints();
    while (why.ends_with('\n')) why.pop_back();
    child_.reset();
    const Then then = std::exchange(then_, {});
    if (*code != 0) return then(reason(why.empty() ? "the preview was given up" : why));
    Json json = Json::parse(printed_, nullptr, false);
    if (!json.is_object()) return then(reason("plabctl printed no preview"));
    then(std::move(json));
}

}  // namespace plab::web
