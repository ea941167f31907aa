/// A scene in a test: blueprint text in, results out. Unexpected warnings fail the test.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "support/load.h"

namespace plab::test
{

inline std::string first_error(const Errors& errors)
{
    std::string all;
    for (const Error& e : errors) all += e.text() + "\n";
    return all;
}

/// The reason for which something was refused; empty if it was accepted.
template <class T>
std::string reasons(const Result<T>& result)
{
    return result.ok() ? std::string() : first_error(result.errors());
}

/// A file of the project; `name` is relative to its root.
inline Result<model::SceneSpec> compile_file(const std::string& name)
{
    return compile_read(blueprint::read_blueprint_file(std::string(PLAB_SOURCE_DIR) + "/" + name));
}

class Scene
{
public:
    /// `body` is the content of <plab>; dt and more go into `settings`, e.g. "dt='1/60'".
    explicit Scene(const std::string& body, const std::string& settings = "dt=\"1/240\"", int threads = 1) : simulation_(library(), threads)
    {
        load(compile_text(whole_scene(body, settings)));
    }
    static Scene file(const std::string& name, int threads = 1) { return Scene(FromFile{}, name, threads); }

    simulation::Simulation& simulation() { return simulation_; }
    const simulation::Simulation& simulation() const { return simulation_; }
    const std::string& error() const { return error_; }
    bool loaded() const { return error_.empty(); }

    void step(std::int64_t n = 1)
    {
        for (std::int64_t i = 0; i < n; ++i)
        {
            simulation_.step();
            for (const Event& e : simulation_.events())
            {
                if (keep_events) events.push_back(e);
                // Each test has its own bounds for the residual of a manager.
                const bool fine = e.severity == Severity::Info || e.kind == "manager.not_converged";
                if (!warnings_expected) CHECK_MESSAGE(fine, e.kind, ": ", e.message);
            }
        }
    }
    /// Steps until the time is t, to the nearest step.
    void run(double t) { step(static_cast<std::int64_t>(std::llround((t - simulation_.time()) / simulation_.dt()))); }

    Value get(const std::string& id, const std::string& field) const
    {
        const std::uint32_t i = simulation_.world().find(id);
        REQUIRE_MESSAGE(i != kNoIndex, "no component ", id);
        return simulation_.world().get(i, field);
    }
    double real(const std::string& id, const std::string& field) const { return std::get<double>(get(id, field)); }
    Vec3 vec(const std::string& id, const std::string& field) const { return std::get<Vec3>(get(id, field)); }
    Quat quat(const std::string& id, const std::string& field) const { return std::get<Quat>(get(id, field)); }
    double spin(const std::string& shaft) const { return real(shaft, "angular_velocity"); }
    double angle(const std::string& shaft) const { return real(shaft, "angle"); }

    std::uint64_t hash() const { return simulation_.state_hash(); }
    /// Executes one request at the present step boundary, without a step.
    simulation::Reply ask(simulation::Operation operation) { return ask_all({std::move(operation)}); }
    simulation::Reply ask_all(std::vector<simulation::Operation> operations)
    {
        simulation::Request request;
        request.operations = std::move(operations);
        return simulation_.carry_out_now(request);
    }
    std::size_t count(const std::string& kind) const
    {
        std::size_t n = 0;
        for (const Event& e : events) n += e.kind == kind ? 1 : 0;
        return n;
    }

    bool warnings_expected = false;
    bool keep_events = false;
    std::vector<Event> events;

private:
    struct FromFile
    {
    };
    Scene(FromFile, const std::string& name, int threads) : simulation_(library(), threads) { load(compile_file(name)); }
    void load(const Result<model::SceneSpec>& scene) { error_ = scene ? reasons(simulation_.load(*scene)) : reasons(scene); }

    simulation::Simulation simulation_;
    std::string error_;
};

/// |a - b| <= tolerance max(1, |b|).
inline bool near(double a, double b, double tolerance) { return std::fabs(a - b) <= tolerance * std::fmax(1.0, std::fabs(b)); }
inline double distance(const Vec3& a, const Vec3& b) { return length(a - b); }
/// Rotation angle between two attitudes, rad.
inline double attitude_error(const Quat& a, const Quat& b)
{
    const Quat d = conjugate(a) * b;
    return 2 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::fabs(d.w));
}

}  // namespace plab::test
