#include "web/jobs.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "idl/values/limits.h"
#include "link/text.h"

namespace plab::web
{
namespace
{

constexpr std::chrono::seconds kLongestStart(30);  ///< until a process has begun what it is for
constexpr std::size_t kMostName = 64;              ///< of a server
constexpr double kMegabyte = 1e6;
constexpr std::uint64_t kLeastRoom = 1'000'000;  ///< bytes: less is too little to begin a recording

constexpr const char* kNoFolder = "recording is off: start plab-web with --recordings DIR";

std::string name_with_time(const std::string& server)
{
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    (void)localtime_r(&now, &local);
    std::array<char, 32> text{};
    (void)std::strftime(text.data(), text.size(), "_%Y-%m-%d_%H-%M-%S", &local);
    return server.substr(0, kMostName - 20) + text.data();
}

/// The last line of what a program complained about, without the program's name.
std::string last_line(std::string text)
{
    while (text.ends_with('\n')) text.pop_back();
    text = text.substr(text.rfind('\n') + 1);
    return link::terminal_text(text.starts_with("plabctl: ") ? text.substr(9) : text);
}

std::uint64_t size_of(const std::string& path)
{
    std::error_code error;
    const auto bytes = std::filesystem::file_size(path, error);
    return error ? 0 : bytes;
}

}  // namespace

Jobs::~Jobs()
{
    for (const Job& job : jobs_) job.child.ask_to_end();  // all at once; then each is waited for
}

std::vector<std::string> Jobs::command(const std::string& server) const
{
    std::vector<std::string> out{program::program_beside("plabctl"), "--json", "--domain", std::to_string(domain_.id)};
    if (!domain_.network_interface.empty()) out.insert(out.end(), {"--interface", domain_.network_interface});
    if (!server.empty()) out.insert(out.end(), {"--server", server});
    return out;
}

std::size_t Jobs::count(Kind kind) const
{
    return static_cast<std::size_t>(std::count_if(jobs_.begin(), jobs_.end(), [&](const Job& job) { return job.kind == kind; }));
}

Jobs::Job* Jobs::find(const std::string& server)
{
    const auto at =
        std::find_if(jobs_.begin(), jobs_.end(), [&](const Job& job) { return job.kind != Kind::Recording && job.name == server; });
    return at == jobs_.end() ? nullptr : &*at;
}

bool Jobs::has_server(const std::string& name) const
{
    return std::any_of(jobs_.begin(), jobs_.end(), [&](const Job& job) { return job.kind != Kind::Recording && job.name == name; });
}

std::vector<std::string> Jobs::playbacks() const
{
    std::vector<std::string> out;
    for (const Job& job : jobs_)
        if (job.kind == Kind::Playback) out.push_back(job.name);
    return out;
}

void Jobs::start(Kind kind, std::string name, std::string of, const std::vector<std::string>& command, Answer answer)
{
    auto child = program::Child::start(command, program::Streams::Piped);
    if (!child) return answer(child.errors());
    jobs_.push_back({kind, std::move(name), std::move(of), child.take(), Clock::now(), std::move(answer), {}});
}

void Jobs::record(const std::string& server, std::string name, Answer answer)
{
    if (recordings_ == nullptr) return answer(reason(kNoFolder));
    if (server.empty()) return answer(reason("there is no server to record"));
    if (count(Kind::Recording) > 0) return answer(reason("another recording is being made: stop it first"));
    if (name.empty()) name = name_with_time(server);
    const auto path = recordings_->path_of(name);
    if (!path) return answer(path.errors());
    if (recordings_->has(name)) return answer(reason("there is a recording '" + name + "' already: choose another name"));
    recordings_->update();
    const std::uint64_t used = recordings_->bytes(), most = recordings_->most_bytes();
    if (used + kLeastRoom > most)
        return answer(reason("the recordings have the " + number_text(static_cast<double>(most) / kMegabyte) +
                             " MB that they may have: delete some, or start plab-web with a larger --recordings-limit"));
    std::vector<std::string> words = command(server);
    words.insert(words.end(), {"record", "-o", path.value(), "--max-size", number_text(static_cast<double>(most - used) / kMegabyte)});
    start(Kind::Recording, name, server, words, std::move(answer));
}

void Jobs::stop_recording(const Answer& answer)
{
    for (Job& job : jobs_)
        if (job.kind == Kind::Recording)
        {
            job.is_ending = true;
            job.child.ask_to_end();
            return answer(Json{{"name", job.name}});
        }
    answer(reason("nothing is being recorded"));
}

void Jobs::play(const std::string& recording, Answer answer)
{
    if (recordings_ == nullptr) return answer(reason(kNoFolder));
    const auto path = recordings_->path_of(recording);
    if (!path) return answer(path.errors());
    if (!recordings_->has(recording)) return answer(reason("there is no recording '" + recording + "'"));
    for (const Job& job : jobs_)
        if (job.of == recording && job.kind == Kind::Playback && job.answer == nullptr) return answer(Json{{"server", job.name}});
    if (count(Kind::Playback) >= kMostPlaybacks)
        return answer(reason(std::to_string(kMostPlaybacks) + " recordings are being played: close one of them first"));
    std::string name = "play-" + recording;
    name.resize(std::min(name.size(), kMostName));
    std::vector<std::string> words = command({});
    words.insert(words.end(), {"play", path.value(), "--name", name, "--control", "--readers", "1"});
    start(Kind::Playback, name, recording, words, std::move(answer));
}

void Jobs::control(const std::string& server, const std::string& line, const Answer& answer)
{
    const Job* const job = find(server);
    if (job == nullptr || job->kind != Kind::Playback) return answer(reason("there is no playback '" + server.substr(0, 80) + "'"));
    if (!job->child.send(line)) return answer(reason("the playback does not listen"));
    answer(Json::object());
}

void Jobs::branch(const std::string& server, std::string name, bool is_paused, Answer answer)
{
    if (server.empty()) return answer(reason("there is no server to branch from"));
    if (count(Kind::Branch) >= kMostBranches)
        return answer(reason("there are " + std::to_string(kMostBranches) + " branches: end one of them first"));
    if (name.empty())
        for (int i = 1; name.empty() || has_server(name); ++i) name = "branch-" + std::to_string(i);
    if (!wire::is_server_name(name) || name.front() == '-')
        return answer(reason("'" + name.substr(0, 80) + "' is no name of a server: use 1 to 64 letters, digits, '.', '_' or '-'"));
    if (name == server || find(name) != nullptr) return answer(reason("there is a server '" + name + "' already: choose another name"));
    std::vector<std::string> words = command(server);
    words.insert(words.end(), {"branch", name, "--attached"});
    if (is_paused) words.emplace_back("--paused");
    start(Kind::Branch, name, server, words, std::move(answer));
}

void Jobs::end(const std::string& server, const Answer& answer)
{
    Job* const job = find(server);
    if (job == nullptr) return answer(reason("there is no playback or branch '" + server.substr(0, 80) + "' of this page's making"));
    job->is_ending = true;
    job->child.ask_to_end();
    answer(Json::object());
}

void Jobs::remove(const std::string& recording, const Answer& answer)
{
    if (recordings_ == nullptr) return answer(reason(kNoFolder));
    for (const Job& job : jobs_)
    {
        if (job.kind == Kind::Recording && job.name == recording)
            return answer(reason("'" + recording + "' is being recorded: stop it first"));
        if (job.kind == Kind::Playback && job.of == recording) return answer(reason("'" + recording + "' is being played: close it first"));
    }
    const auto removed = recordings_->remove(recording);
    if (!removed) return answer(removed.errors());
    recordings_->update();
    answer(Json::object());
}

std::string Jobs::recorded_path(const Job& job) const
{
    const auto path = recordings_ == nullptr ? Result<std::string>(reason("")) : recordings_->path_of(job.name);
    return path ? path.value() : std::string();
}

void Jobs::take_output(Job& job)
{
    bool has_begun = job.kind == Kind::Recording && size_of(recorded_path(job)) > 0;
    for (const std::string& line : job.child.take_lines())
    {
        const Json said = Json::parse(line, nullptr, false);
        if (!said.is_object() || job.kind == Kind::Recording) continue;
        has_begun = true;
        if (job.kind == Kind::Playback) job.position = line;
    }
    if (has_begun && job.answer) std::exchange(job.answer, nullptr)(Json{{job.kind == Kind::Recording ? "name" : "server", job.name}});
    if (job.answer && Clock::now() - job.begun > kLongestStart) job.child.ask_to_end();
}

std::string Jobs::why_ended(Job& job, int code) const
{
    const std::string complaint = last_line(job.child.complaints());
    if (!complaint.empty()) return complaint;
    return code == 0 ? "it has come to its end" : "it ended with code " + std::to_string(code);
}

void Jobs::finish(Job& job, int code)
{
    if (job.answer) return job.answer(reason(why_ended(job, code)));
    if (job.is_ending) return;
    if (job.kind == Kind::Recording)
    {
        recordings_->update();
        const bool is_full = recordings_->bytes() + kLeastRoom > recordings_->most_bytes();
        const std::string why = is_full
                                    ? "the recordings have the " + number_text(static_cast<double>(recordings_->most_bytes()) / kMegabyte) +
                                          " MB that they may have"
                                    : why_ended(job, code);
        notices_.push_back("Recording " + job.name + " has ended: " + why + ".");
    }
    else
        notices_.push_back((job.kind == Kind::Branch ? "Branch " : "Playback ") + job.name + " has ended: " + why_ended(job, code) + ".");
}

void Jobs::update()
{
    for (auto at = jobs_.begin(); at != jobs_.end();)
    {
        // First whether it has ended, then what it said: nothing comes after that.
        const std::optional<int> code = at->child.exit_code();
        take_output(*at);
        if (code) finish(*at, *code);
        at = code ? jobs_.erase(at) : std::next(at);
    }
}

Json Jobs::state() const
{
    Json out{{"recording", nullptr}, {"servers", Json::array()}};
    for (const Job& job : jobs_)
    {
        if (job.kind == Kind::Recording)
            out["recording"] = {{"name", job.name},
                                {"server", job.of},
                                {"seconds", std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - job.begun).count()},
                                {"bytes", size_of(recorded_path(job))},
                                {"is_ending", job.is_ending}};
        else
            out["servers"].push_back({{"name", job.name},
                                      {"kind", job.kind == Kind::Branch ? "branch" : "playback"},
                                      {"of", job.of},
                                      {"is_there", job.answer == nullptr && !job.is_ending}});
    }
    return out;
}

std::string Jobs::take_position(const std::string& playback)
{
    Job* const job = find(playback);
    return job == nullptr ? std::string() : std::exchange(job->position, {});
}

std::vector<std::string> Jobs::take_notices() { return std::exchange(notices_, {}); }

}  // namespace plab::web
