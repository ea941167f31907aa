// What a recording costs the step thread, and how large it is: A/B in one run, interleaved.
//
//   bench_record [--objects N] [--hz N] [--seconds S] [FOLDER]
//
// N bodies that tumble freely under gravity, stepped at 1 kHz: once alone, once with a recorder that writes every step to
// FOLDER (default: the present one). Processor time of the step thread: the median of pieces of
// 100 steps, and of what a piece with the recorder took beyond the one beside it.
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

std::string scene_of(int objects, int hz)
{
    std::string text = "<plab version=\"1\"><scene dt=\"1/" + std::to_string(hz) +
                       "\"/><component id=\"g\" type=\"Field/Gravity\" between=\"*\"/><component id=\"s\" type=\"Shape/Box\" "
                       "half_extents=\"0.1 0.2 0.3\"/>";
    for (int i = 0; i < objects; ++i)
    {
        const std::string n = std::to_string(i);
        text += "<component id=\"b" + n + "\" type=\"State/RigidBody\" shape=\"s\" mass=\"1\" position=\"" + n +
                " 0 0\" angular_velocity=\"0." + n + " 1 2\"/>";
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

/// A run, and whoever watches it.
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
        // As plabd does it: taken here, written down by a thread of its own.
        if (encoding.valid()) collector.snapshot(encoding.get());
        publish::SnapshotRecord record;
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
    std::future<publish::SnapshotRecord> encoding;
    bool watched;
};

void compare(const std::string& label, int objects, int hz, double seconds, record::RecordOptions options)
{
    std::filesystem::remove(options.file);
    auto recorder = record::Recorder::open(options);
    if (!recorder)
    {
        std::fprintf(stderr, "%s\n", recorder.error().text().c_str());
        std::exit(1);
    }
    const std::string scene = scene_of(objects, hz);
    Run alone(scene, nullptr), recorded(scene, recorder->get());
    std::vector<double> a, b, extra;
    for (int i = 0; i < static_cast<int>(seconds * hz / 100); ++i)
    {
        // In turn, each first as often as the other: what else the machine does meets both.
        const bool first = i % 2 == 0;
        if (first) a.push_back(alone.piece());
        b.push_back(recorded.piece());
        if (!first) a.push_back(alone.piece());
        extra.push_back(b.back() - a.back());
    }
    (void)(*recorder)->close();
    const publish::RecordingStatus status = (*recorder)->progress();
    const double bytes = static_cast<double>(status.bytes) / objects / seconds;
    std::printf("%-28s %8.1f us/step alone %+8.1f recorded  %+6.2f %%   %8.0f bytes/object/s   %llu dropped\n", label.c_str(),
                median(a) * 1e6, median(extra) * 1e6, 100 * median(extra) / median(a), bytes,
                static_cast<unsigned long long>(status.dropped));
    std::filesystem::remove(options.file);
}

}  // namespace

int main(int argc, char** argv)
{
    int objects = 1000, hz = 1000;
    double seconds = 5;
    std::string folder = ".";
    for (int i = 1; i < argc; ++i)
    {
        const std::string word = argv[i];
        if (word == "--objects" && i + 1 < argc)
            objects = std::atoi(argv[++i]);
        else if (word == "--hz" && i + 1 < argc)
            hz = std::atoi(argv[++i]);
        else if (word == "--seconds" && i + 1 < argc)
            seconds = std::atof(argv[++i]);
        else
            folder = word;
    }
    record::RecordOptions options;
    options.file = folder + "/bench_record.mcap", options.server = "bench", options.dt = 1.0 / hz;
    for (const char* compression : {"none", "lz4", "zstd"})
    {
        options.compression = compression;
        compare(compression, objects, hz, seconds, options);
    }
    options.state_interval = 1.0 / 60;
    compare("zstd, 60 frames/s", objects, hz, seconds, options);
    options.topics = {"plab/states"};
    compare("zstd, 60 frames/s, no hashes", objects, hz, seconds, options);
    return 0;
}
