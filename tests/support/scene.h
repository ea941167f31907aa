/// A scene in a test: blueprint text in, figures out. Unexpected warnings fail the test.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "blueprint/reader.h"
#include "model/compile.h"
#include "plugins/library.h"
#include "simulation/simulation.h"

namespace plab::test
{

/// The plugins of this build, shared by all scenes of a test binary.
inline plugins::PluginLibrary& library()
{
    static plugins::PluginLibrary instance({PLAB_BINARY_DIR "/lib/plab"});
    return instance;
}

inline std::string first_error(const Errors& errors)
{
    std::string all;
    for (const Error& e : errors) all += e.text() + "\n";
    return all;
}

class Scene
{
public:
    /// `body` is what stands inside <plab>; dt and more go into `settings`, e.g. "dt='1/60'".
    explicit Scene(const std::string& body, const std::string& settings = "dt=\"1/240\"", int threads = 1) : simulation_(library(), threads)
    {
        load_text("<plab version=\"1\"><scene " + settings + "/>" + body + "</plab>", "scene.xml");
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
                if (!warnings_expected) CHECK_MESSAGE(e.severity == Severity::Info, e.kind, ": ", e.message);
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
    /// Carries out one request at the present boundary, without a step.
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
    Scene(FromFile, const std::string& name, int threads) : simulation_(library(), threads)
    {
        auto blueprint = blueprint::read_blueprint_file(std::string(PLAB_SOURCE_DIR) + "/" + name);
        if (blueprint)
            build(*blueprint);
        else
            error_ = first_error(blueprint.errors());
    }
    void load_text(const std::string& text, const std::string& name)
    {
        auto blueprint = blueprint::read_blueprint(text, name);
        if (blueprint)
            build(*blueprint);
        else
            error_ = first_error(blueprint.errors());
    }
    void build(const model::Blueprint& blueprint)
    {
        auto scene = model::compile(blueprint, library());
        if (!scene)
        {
            error_ = first_error(scene.errors());
            return;
        }
        if (auto loaded = simulation_.load(*scene); !loaded) error_ = first_error(loaded.errors());
    }

    simulation::Simulation simulation_;
    std::string error_;
};

/// |a - b| <= tolerance max(1, |b|).
inline bool near(double a, double b, double tolerance) { return std::fabs(a - b) <= tolerance * std::fmax(1.0, std::fabs(b)); }
inline double distance(const Vec3& a, const Vec3& b) { return length(a - b); }
/// Angle of the rotation between two attitudes, rad.
inline double attitude_error(const Quat& a, const Quat& b)
{
    const Quat d = conjugate(a) * b;
    return 2 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::fabs(d.w));
}

}  // namespace plab::test
