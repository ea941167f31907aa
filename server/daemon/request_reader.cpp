#include "daemon/request_reader.h"

#include <pthread.h>

#include <csignal>
#include <utility>

#include "control/preparation.h"

namespace plab::daemon
{
namespace
{

/// How long the reader waits for the requests before an addition to be carried out, so that it can be compiled for the scene that they
/// leave. A step or a trial may take longer; then the addition is compiled for the scene that is there.
constexpr std::chrono::milliseconds kLongestWait(100);

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
    ++taken_;
    return true;
}

void RequestReader::show(std::shared_ptr<const model::SceneSpec> scene)
{
    {
        const std::lock_guard lock(mutex_);
        if (served_ == taken_ && scene_ == scene) return;
        served_ = taken_;
        if (scene_ != scene) outdated_.push_back(std::exchange(scene_, std::move(scene)));
    }
    changed_.notify_all();
}

void RequestReader::finish(std::chrono::milliseconds most)
{
    // The caller is the thread for which an addition may be waiting.
    {
        const std::lock_guard lock(mutex_);
        is_finishing_ = true;
    }
    notify();
    std::unique_lock lock(mutex_);
    (void)changed_.wait_for(lock, most, [this] { return !notified_ && !reading_; });
    is_finishing_ = false;
}

void RequestReader::run(const std::stop_token& stop)
{
    for (;;)
    {
        std::vector<std::shared_ptr<const model::SceneSpec>> outdated;  // destroyed here, not on the step thread
        {
            std::unique_lock lock(mutex_);
            if (!changed_.wait(lock, stop, [this] { return notified_ || !outdated_.empty(); })) return;
            outdated.swap(outdated_);
            if (!notified_) continue;
            notified_ = false, reading_ = true;
        }
        ReadRequest next;
        while (!stop.stop_requested() && source_(next.text))
        {
            next.wanted = control::wanted_of(next.text, *types_, limits_);
            if (next.wanted) prepare(next.wanted->request, stop);
            {
                const std::lock_guard lock(mutex_);
                read_.push_back(std::exchange(next, {}));
                ++handed_over_;
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

/// The scene after the requests that were read so far, if they are carried out soon.
std::shared_ptr<const model::SceneSpec> RequestReader::present_scene(const std::stop_token& stop)
{
    std::unique_lock lock(mutex_);
    (void)changed_.wait_for(lock, stop, kLongestWait, [this] { return served_ == handed_over_ || is_finishing_; });
    return scene_;
}

void RequestReader::prepare(simulation::Request& request, const std::stop_token& stop)
{
    control::load_types(request, *types_);
    if (control::has_additions(request)) control::prepare_additions(request, *types_, present_scene(stop), limits_);
}

}  // namespace plab::daemon
