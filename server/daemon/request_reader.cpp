#include "daemon/request_reader.h"

#include <pthread.h>

#include <csignal>
#include <set>
#include <utility>

namespace plab::daemon
{
namespace
{

/// Loads the plugin of a type, also if only the end of its name is written. Whether the type fits is checked when the request takes
/// effect; an error here will occur there again.
void load_named(model::TypeSource& types, const std::string& written)
{
    for (const std::string& name : types.names())
        if (name == written || name.ends_with("/" + written)) (void)types.require(name);
}

void collect_types(const std::vector<model::ComponentNode>& nodes, std::set<std::string>& out)
{
    for (const model::ComponentNode& node : nodes)
    {
        if (!node.type.empty()) out.insert(node.type);
        collect_types(node.children, out);
    }
}

}  // namespace

RequestReader::RequestReader(Source source, model::TypeSource& types, const model::CompileLimits& limits, std::function<void()> ready)
    : source_(std::move(source)), types_(&types), limits_(limits), ready_(std::move(ready))
{
    // Signals belong to the main thread: none is delivered on this one.
    sigset_t all, before;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    (void)pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

RequestReader::~RequestReader() = default;

void RequestReader::stop()
{
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
}

void RequestReader::notify()
{
    {
        const std::lock_guard lock(mutex_);
        notified_ = true;
    }
    changed_.notify_all();
}

bool RequestReader::take(ReadRequest& request)
{
    const std::lock_guard lock(mutex_);
    if (read_.empty()) return false;
    request = std::move(read_.front());
    read_.pop_front();
    return true;
}

void RequestReader::finish(std::chrono::milliseconds most)
{
    notify();
    std::unique_lock lock(mutex_);
    (void)changed_.wait_for(lock, most, [this] { return !notified_ && !reading_; });
}

void RequestReader::run(const std::stop_token& stop)
{
    for (;;)
    {
        {
            std::unique_lock lock(mutex_);
            if (!changed_.wait(lock, stop, [this] { return notified_; })) return;
            notified_ = false, reading_ = true;
        }
        ReadRequest next;
        while (!stop.stop_requested() && source_(next.text))
        {
            next.wanted = control::wanted_of(next.text, *types_, limits_);
            if (next.wanted) load_types(*next.wanted);
            {
                const std::lock_guard lock(mutex_);
                read_.push_back(std::exchange(next, {}));
            }
            ready_();
        }
        {
            const std::lock_guard lock(mutex_);
            reading_ = false;
        }
        changed_.notify_all();
    }
}

void RequestReader::load_types(const control::Wanted& wanted)
{
    std::set<std::string> named;
    for (const simulation::Operation& op : wanted.request.operations)
    {
        if (const auto* swap = std::get_if<simulation::SwapOperation>(&op)) named.insert(swap->type);
        const auto* add = std::get_if<simulation::AddBlueprintOperation>(&op);
        if (!add) continue;
        collect_types(add->blueprint.components, named);
        for (const model::RepeatNode& repeat : add->blueprint.repeats) collect_types(repeat.components, named);
    }
    for (const std::string& type : named) load_named(*types_, type);
}

}  // namespace plab::daemon
