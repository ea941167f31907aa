/// Reads the requests of clients on a thread of its own: parses blueprints, compiles them, and loads the plugins of the types that a
/// request names. A step does not wait for XML, for the dynamic linker or for the compiler of blueprints.
///
/// What a request adds is compiled for the scene as it was when the step thread showed it last. If the scene has changed by the time the
/// request takes effect, the step thread compiles it once more (simulation::PreparedAddition). To make this rare, an addition is read only
/// after the requests before it have been carried out, if that does not take long.
///
/// Shared between the threads, under one mutex: the requests that were read, their counts, and the pointer to the present scene. The scene
/// itself is a value that was lent (world::Shared) and never changes.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "control/operations.h"
#include "publish/records.h"

namespace plab::daemon
{

class RequestReader
{
public:
    struct ReadRequest
    {
        publish::ReceivedRequest text;
        Result<control::Wanted> wanted = Error{};
    };
    /// Where requests come from: false if there is none. Called on the reader's thread only.
    using Source = std::function<bool(publish::ReceivedRequest&)>;

    /// `types` must be usable from several threads. `ready` is called on the reader's thread whenever a request has been read.
    RequestReader(Source source, model::TypeSource& types, const model::CompileLimits& limits, std::function<void()> ready);
    ~RequestReader();
    RequestReader(const RequestReader&) = delete;
    RequestReader& operator=(const RequestReader&) = delete;

    /// The source may have requests. Any thread.
    void notify();
    /// Ends the thread; what has not been read stays unread.
    void stop();
    /// The next request, in the order in which they arrived. False if none has been read completely. Step thread.
    bool take(ReadRequest& request);
    /// The scene now that all requests that were taken have been carried out, were refused, or wait for their step. Step thread.
    void show(std::shared_ptr<const model::SceneSpec> scene);
    /// Waits until everything that has arrived is read, but not longer than `most`.
    void finish(std::chrono::milliseconds most);

private:
    void run(const std::stop_token& stop);
    void prepare(simulation::Request& request, const std::stop_token& stop);
    std::shared_ptr<const model::SceneSpec> present_scene(const std::stop_token& stop);

    Source source_;
    model::TypeSource* types_;
    model::CompileLimits limits_;
    std::function<void()> ready_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    bool notified_ = false, reading_ = false, is_finishing_ = false;
    std::deque<ReadRequest> read_;
    std::uint64_t handed_over_ = 0, taken_ = 0, served_ = 0;  ///< requests: read; given to the step thread; done with by it
    std::shared_ptr<const model::SceneSpec> scene_;
    std::vector<std::shared_ptr<const model::SceneSpec>> outdated_;  ///< scenes that this thread is to destroy
    std::jthread thread_;                                            ///< last: uses all of the above
};

}  // namespace plab::daemon
