/// A server that plays a script on the bus, for clients that are tested without the real one: a red ball falls from 3 m
/// onto a plane, a wheel turns on its shaft. It runs on a thread of the test.
#pragma once

#include <string>
#include <thread>

#include "idl/domain.h"

namespace plab::test
{

struct Script
{
    double rate = 1;             ///< of real time; states come 60 times per simulated second
    double first_time = 0;       ///< s
    double until = 0.5;          ///< s; then time stops
    bool leaves = false;         ///< or the server ends, in an orderly way
    bool paused = false;         ///< from the start, and sends no states
    std::int64_t swap_at = -1;   ///< step from which the response is another one
    std::int64_t late_at = -1;   ///< step from which states have a box, which the catalogue lists 0.1 s later
    std::int64_t reset_at = -1;  ///< step at which run 2 begins
    std::size_t interactions = 2;
};

/// Height of the ball, m.
inline double height_at(double time) { return 3 - 0.5 * 9.81 * time * time; }

class FakeServer
{
public:
    static constexpr double kDt = 1.0 / 240;

    /// In the domain of PLAB_DOMAIN. Time begins with the first subscriber of states.
    explicit FakeServer(const Script& script);
    ~FakeServer();
    FakeServer(const FakeServer&) = delete;
    FakeServer& operator=(const FakeServer&) = delete;

    const std::string& name() const { return name_; }

private:
    void serve(const std::stop_token& stop);

    Script script_;
    std::string name_;
    std::jthread thread_;
};

}  // namespace plab::test
