/// A server's end of the bus and clients of it, in one process and on loopback.
#pragma once

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bus/server_bus.h"
#include "doctest/doctest.h"
#include "link/caller.h"

namespace plab::test
{

using namespace std::chrono_literals;

/// Polls until the condition holds; false if it did not in time.
inline bool eventually(const std::function<bool()>& holds, std::chrono::milliseconds longest = 5s)
{
    const auto end = std::chrono::steady_clock::now() + longest;
    while (!holds())
    {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(1ms);
    }
    return true;
}

/// A bus with a unique name, and the messages that it sent to the daemon.
class TestBus
{
public:
    explicit TestBus(std::string name = unused_name())
    {
        options_.name = std::move(name), options_.version = "test";
        options_.domain = domain();
        options_.wake = [](void* self) { ++static_cast<TestBus*>(self)->wakes_; };
        options_.wake_argument = this;
        options_.log = [](void* self, const char* line) { static_cast<TestBus*>(self)->note(line); };
        options_.log_argument = this;
        auto opened = bus::ServerBus::open(options_);
        REQUIRE_MESSAGE(opened.ok(), (opened ? "" : opened.error().text()));
        bus_ = opened.take();
    }
    bus::Bus* operator->() { return bus_.get(); }
    const bus::BusOptions& options() const { return options_; }
    void close() { bus_.reset(); }
    int wakes() const { return wakes_; }
    std::vector<std::string> log()
    {
        const std::lock_guard guard(mutex_);
        return log_;
    }

    link::Session session() const
    {
        auto session = link::Session::join({options_.name, {options_.domain, ""}});
        REQUIRE(session.ok());
        return session.take();
    }

    static std::uint32_t domain()
    {
        const auto options = wire::domain_from_environment();
        return options && options->id != 0 ? options->id : 41;
    }
    static std::string unused_name()
    {
        static std::atomic<int> count{0};
        return "unit-bus-" + std::to_string(getpid()) + "-" + std::to_string(++count);
    }

private:
    void note(const char* line)
    {
        const std::lock_guard guard(mutex_);
        log_.emplace_back(line);
    }

    bus::BusOptions options_;
    std::atomic<int> wakes_{0};
    std::mutex mutex_;
    std::vector<std::string> log_;
    std::unique_ptr<bus::Bus> bus_;
};

template <class T>
wire::DataReader<T> reader_of(const link::Session& session)
{
    auto reader = session.reader<T>();
    REQUIRE(reader.ok());
    return reader.take();
}

/// One frame with `bodies` bodies, handed over as the collector does.
inline void push_frame(bus::Bus& bus, std::uint64_t number, std::size_t bodies)
{
    wire::Frame& frame = bus.begin_frame();
    frame.run = 3, frame.revision = 5, frame.sequence_number = number, frame.step = static_cast<Tick>(number) * 4;
    frame.time = 0.25 * static_cast<double>(number), frame.stamp_ns = 77;
    frame.bodies.resize(bodies);
    for (std::size_t i = 0; i < bodies; ++i)
    {
        const auto x = static_cast<double>(i);
        frame.bodies[i] = {static_cast<std::uint32_t>(i), {x, x + 1, x + 2}, {0.5, 0.5, -0.5, 0.5}, {x, 0, -x}, {0, x, 1}};
    }
    frame.shafts.assign(1, {900, 1.5, -2.5});
    bus.end_frame();
}

}  // namespace plab::test
