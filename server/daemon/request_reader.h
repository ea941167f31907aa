/// Reads the requests of clients on a thread of its own: parses blueprints, compiles scenes to load, and loads the plugins of the types
/// that a request names. A step does not wait for XML or for the dynamic linker. What a request adds to the running scene is still compiled
/// on the step thread, because that depends on the scene.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "control/operations.h"
#include "publish/records.h"

namespace plab::daemon
{

class RequestReader
{
public:
    struct ReadRequest
    {
        publish::RequestText text;
        Result<control::Wanted> wanted = Error{};
    };
    /// Where requests come from: false if there is none. Called on the reader's thread only.
    using Source = std::function<bool(publish::RequestText&)>;

    /// `types` must be usable from several threads. `ready` is called on the reader's thread whenever a request has been read.
    RequestReader(Source source, model::TypeSource& types, const model::CompileLimits& limits, std::function<void()> ready);
    ~RequestReader();
    RequestReader(const RequestReader&) = delete;
    RequestReader& operator=(const RequestReader&) = delete;

    /// The source may have requests. Any thread.
    void notify();
    /// Ends the thread; what has not been read stays unread.
    void stop();
    /// The next request, in the order in which they arrived. False if none has been read completely.
    bool take(ReadRequest& request);
    /// Waits until everything that has arrived is read, but not longer than `most`.
    void finish(std::chrono::milliseconds most);

private:
    void run(const std::stop_token& stop);
    void load_types(const control::Wanted& wanted);

    Source source_;
    model::TypeSource* types_;
    model::CompileLimits limits_;
    std::function<void()> ready_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    bool notified_ = false, reading_ = false;
    std::deque<ReadRequest> read_;
    std::jthread thread_;  ///< last: uses all of the above
};

}  // namespace plab::daemon
