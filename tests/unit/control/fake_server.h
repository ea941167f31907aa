/// A server without a simulation: it publishes a small scene and answers requests by a script, so that a client can be
/// tested alone.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "idl/domain.h"

namespace plab::test
{

/// A request as it arrived, in words.
struct Asked
{
    struct Part
    {
        std::string verb, target, argument, blueprint;
        std::vector<std::pair<std::string, std::string>> values;
    };
    std::vector<Part> parts;
    std::int64_t at = -1, revision = -1;
};

class FakeServer
{
public:
    FakeServer(std::uint32_t domain, std::string name);
    ~FakeServer();
    FakeServer(const FakeServer&) = delete;
    FakeServer& operator=(const FakeServer&) = delete;

    const std::string& name() const { return name_; }
    /// Takes the last request.
    Asked last();
    /// Sequence numbers of events and collisions jump over so many.
    void skip_numbers(std::uint64_t count) { skip_ += count; }
    /// Answers like a server that is at this step.
    void go_to_step(std::int64_t step) { step_ = step; }
    /// Shows a recording on a disk that is full.
    void fill_disk() { disk_is_full_ = true; }

private:
    struct Ends;

    void run();
    void publish_catalogue();
    void publish_types();
    void publish_state();
    void publish_metrics();
    void publish_motion();
    void publish_log();
    void answer(const plab_v2_Request& request);
    std::vector<std::string> objections(const plab_v2_Request& request) const;
    void reply(const plab_v2_Request& request, const std::vector<std::string>& reasons);

    std::string name_;
    std::unique_ptr<Ends> ends_;
    std::atomic<bool> stop_{false}, disk_is_full_{false};
    std::atomic<std::uint64_t> skip_{0};
    std::atomic<std::int64_t> step_{1200};
    std::uint64_t number_ = 1, frames_ = 0;
    bool paused_ = false;
    std::mutex mutex_;
    Asked last_;
    std::thread thread_;
};

}  // namespace plab::test
