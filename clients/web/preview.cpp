#include "web/preview.h"

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "link/text.h"

extern char** environ;

namespace plab::web
{
namespace
{

constexpr std::chrono::seconds kLongest(60);
constexpr std::size_t kMostPrinted = 1u << 20;  ///< bytes

/// plabctl beside this program, or the one that PATH finds.
std::string plabctl_program()
{
    std::error_code error;
    const std::filesystem::path beside = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "plabctl";
    return !error && std::filesystem::exists(beside, error) ? beside.string() : "plabctl";
}

std::string printed_in(std::FILE* file)
{
    std::string out(kMostPrinted, '\0');
    std::rewind(file);
    out.resize(std::fread(out.data(), 1, out.size(), file));
    while (out.ends_with('\n')) out.pop_back();
    return out;
}

std::vector<std::string> command_of(const link::SessionOptions& server, const PreviewAsk& ask)
{
    std::vector<std::string> out{plabctl_program(), "--json", "--server", server.server, "--domain", std::to_string(server.domain.id)};
    if (!server.domain.network_interface.empty()) out.insert(out.end(), {"--interface", server.domain.network_interface});
    // No word begins with '-': parse_said() has refused those.
    out.insert(out.end(), {"shadow", ask.component, "--with", ask.type, "--for", link::number_text(ask.seconds)});
    return out;
}

/// The process id, or the error.
int spawn(std::vector<std::string> command, int output, int complaints, int& error)
{
    posix_spawn_file_actions_t actions;
    (void)posix_spawn_file_actions_init(&actions);
    (void)posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    (void)posix_spawn_file_actions_adddup2(&actions, complaints, STDERR_FILENO);
    std::vector<char*> words;
    for (std::string& word : command) words.push_back(word.data());
    words.push_back(nullptr);
    pid_t process = 0;
    error = posix_spawnp(&process, words.front(), &actions, nullptr, words.data(), environ);
    (void)posix_spawn_file_actions_destroy(&actions);
    return process;
}

}  // namespace

Preview::~Preview()
{
    if (process_ == 0) return;
    (void)kill(process_, SIGTERM);
    (void)waitpid(process_, nullptr, 0);
}

void Preview::start(const link::SessionOptions& server, const PreviewAsk& ask, Then then)
{
    if (process_ != 0) return then(reason("another preview is being made; try again"));
    output_.reset(std::tmpfile()), complaints_.reset(std::tmpfile());
    if (output_ == nullptr || complaints_ == nullptr) return then(reason("cannot make a temporary file"));
    int error = 0;
    const int process = spawn(command_of(server, ask), fileno(output_.get()), fileno(complaints_.get()), error);
    if (error != 0) return then(reason(std::string("cannot start plabctl: ") + std::strerror(error)));
    process_ = process, then_ = std::move(then);
    end_ = std::chrono::steady_clock::now() + kLongest;
}

void Preview::update()
{
    if (process_ == 0) return;
    int status = 0;
    if (waitpid(process_, &status, WNOHANG) != process_)
    {
        if (std::chrono::steady_clock::now() >= end_) (void)kill(process_, SIGTERM);
        return;
    }
    process_ = 0;
    const Then then = std::exchange(then_, {});
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    {
        const std::string why = printed_in(complaints_.get());
        return then(reason(why.empty() ? "the preview was given up" : why));
    }
    Json json = Json::parse(printed_in(output_.get()), nullptr, false);
    if (!json.is_object()) return then(reason("plabctl printed no preview"));
    then(std::move(json));
}

}  // namespace plab::web
