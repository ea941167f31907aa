// The time that a recording takes on the step thread, and its size: A/B in one run, interleaved.
//
//   bench_record [--objects N] [--hz N] [--seconds S] [--pile] [FOLDER]
//
// N bodies that tumble freely under gravity, or bricks in piles, stepped at 1 kHz: once alone, once with a recorder that writes every step
// to FOLDER (default: the present one). Processor time of the step thread: the median of pieces of 100 steps, and of the additional
// time of a piece with the recorder over its neighbour without.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include "publish/collector.h"
#include "record/recorder.h"
#include "simulation/snapshot/format.h"
#include "support/load.h"

namespace
{

using namespace plab;

double thread_seconds()
{
    timespec now{};
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

std::string begin_of(int hz)
{
    return "<plab version=\"1\"><scene dt=\"1/" + std::to_string(hz) + "\"/><component id=\"g\" type=\"Field/Gravity\" between=\"*\"/>";
}

/// The cheapest scene to step, so that the cost of a recording is most visible.
std::string free_bodies(int objects, int hz)
{
    std::string text = begin_of(hz) + "<component id=\"s\" type=\"Shape/Box\" half_extents=\"0.1 0.2 0.3\"/>";
    for (int i = 0; i < objects; ++i)
    {
        const std::string n = std::to_string(i);
        text += "<component id=\"b" + n + "\" type=\"State/RigidBody\" shape=\"s\" mass=\"1\" position=\"" + n +
                " 0 0\" angular_velocity=\"0." + n + " 1 2\"/>";
    }
    return text + "</plab>";
}

/// Bricks stacked on one another, ten by ten in a layer, that topple: each is rotated slightly against the one below.
std::string pile(int objects, int hz)
{
    std::string text = begin_of(hz) +
                       "<component id=\"floor\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"floor\"/>"
                       "<component id=\"s\" type=\"Shape/Box\" half_extents=\"0.1 0.1 0.05\"/>"
                       "<component id=\"m\" type=\"Manager/SequentialImpulse\"/>"
                       "<component id=\"r\" type=\"Response/Rows\" friction=\"0.5\" restitution=\"0\" manager=\"m\"/>"
                       "<component id=\"c\" type=\"CDetection/ODE\" between=\"*\" resolution=\"Resolution/None\" response=\"r\"/>";
    for (int i = 0; i < objects; ++i)
    {
        const int layer = i / 100;
        const double x = 0.21 * (i % 10) + 0.02 * layer, y = 0.21 * (i / 10 % 10), z = 0.05 + 0.1001 * layer;
        text += "<component id=\"b" + std::to_string(i) + "\" type=\"State/RigidBody\" shape=\"s\" mass=\"1\" position=\"" +
                std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\" orientation=\"axis 0 0 1 " +
                std::to_string(3 * layer) + " deg\"/>";
    }
    return text + "</plab>";
}

std::unique_ptr<simulation::Simulation> load(const std::string& scene)
{
    auto loaded = test::load_text(scene);
    if (loaded) return loaded.take();
    std::fprintf(stderr, "%s\n", loaded.error().text().c_str());
    std::exit(1);
}

/// A run and its observers.
struct Run
{
    Run(const std::string& scene, record::Recorder* recorder)
        : simulation(load(scene)), collector({}, test::library().summaries()), watched(recorder != nullptr)
    {
        if (recorder) collector.attach(*recorder);
        publish(false);
    }
    void publish(bool stepped)
    {
        collector.collect(*simulation, simulation->take_changes(), stepped);
        const auto cause = watched ? collector.wants_snapshot(*simulation) : std::nullopt;
        if (!cause) return;
        // As in plabd: captured here, written by a thread of its own.
        if (encoding.valid()) collector.snapshot(encoding.get());
        wire::Snapshot record;
        record.run = simulation->run(), record.step = simulation->tick(), record.time = simulation->time(), record.cause = *cause;
        encoding = std::async(std::launch::async,
                              [record, snapshot = simulation->capture()]() mutable
                              {
                                  record.data = simulation::encode(snapshot).take();
                                  return record;
                              });
    }
    double piece()
    {
        constexpr int kSteps = 100;
        const double begin = thread_seconds();
        for (int i = 0; i < kSteps; ++i) simulation->step(), publish(true);
        return (thread_seconds() - begin) / kSteps;
    }
    std::unique_ptr<simulation::Simulation> simulation;
    publish::Collector collector;
    std::future<wire::Snapshot> encoding;
    bool watched;
};

struct Plan
{
    std::string scene;
    int objects = 1000, hz = 1000;
    double seconds = 5;
};

void compare(const std::string& label, const Plan& plan, const record::RecordOptions& options)
{
    std::filesystem::remove(options.file);
    auto recorder = record::Recorder::open(options);
    if (!recorder)
    {
        std::fprintf(stderr, "%s\n", recorder.error().text().c_str());
        std::exit(1);
    }
    Run alone(plan.scene, nullptr), recorded(plan.scene, recorder->get());
    std::vector<double> a, b, extra;
    for (int i = 0; i < static_cast<int>(plan.seconds * plan.hz / 100); ++i)
    {
        // Alternately, each first as often as the other, so that other load on the machine affects both.
        const bool first = i % 2 == 0;
        if (first) a.push_back(alone.piece());
        b.push_back(recorded.piece());
        if (!first) a.push_back(alone.piece());
        extra.push_back(b.back() - a.back());
    }
    (void)(*recorder)->close();
    const wire::RecordingInfo status = (*recorder)->progress();
    const double bytes = static_cast<double>(status.bytes) / plan.objects / plan.seconds;
    std::printf("%-28s %8.1f us/step alone %+8.1f recorded  %+6.2f %%   %8.0f bytes/object/s   %llu dropped\n", label.c_str(),
                median(a) * 1e6, median(extra) * 1e6, 100 * median(extra) / median(a), bytes,
                static_cast<unsigned long long>(status.dropped));
    std::filesystem::remove(options.file);
}

}  // namespace

int main(int argc, char** argv)
{
    Plan plan;
    bool piled = false;
    std::string folder = ".";
    for (int i = 1; i < argc; ++i)
    {
        const std::string word = argv[i];
        if (word == "--objects" && i + 1 < argc)
            plan.objects = std::atoi(argv[++i]);
        else if (word == "--hz" && i + 1 < argc)
            plan.hz = std::atoi(argv[++i]);
        else if (word == "--seconds" && i + 1 < argc)
            plan.seconds = std::atof(argv[++i]);
        else if (word == "--pile")
            piled = true;
        else
            folder = word;
    }
    plan.scene = piled ? pile(plan.objects, plan.hz) : free_bodies(plan.objects, plan.hz);
    record::RecordOptions options;
    options.file = folder + "/bench_record.mcap", options.server = "bench", options.dt = 1.0 / plan.hz;
    for (const char* compression : {"none", "lz4", "zstd"})
    {
        options.compression = compression;
        compare(compression, plan, options);
    }
    options.state_interval = 1.0 / 60;
    compare("zstd, 60 frames/s", plan, options);
    options.moved_only = true;
    compare("zstd, 60 frames/s, moved", plan, options);
    options.moved_only = false, options.topics = {"plab/states"};
    compare("zstd, 60 frames/s, no hashes", plan, options);
    return 0;
}
