// Prints the bus's figures: frames per second and CPU per frame, latencies, pause of a swap, start, the cost of a stopped
// observer. Real processes on loopback. CSV on standard output: name, unit, value. Not a test: timings are not checked.
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <thread>

#include "link/caller.h"
#include "support/process.h"

using namespace plab;
using namespace plab::test;
using link::Seconds;
using Clock = std::chrono::steady_clock;

namespace
{

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

std::int64_t now_real_ns()
{
    timespec t{};
    clock_gettime(CLOCK_REALTIME, &t);
    return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

double quantile(std::vector<double> v, double q)
{
    if (v.empty()) return 0;
    std::sort(v.begin(), v.end());
    return v[std::min(v.size() - 1, static_cast<std::size_t>(q * static_cast<double>(v.size())))];
}

void print(const std::string& name, const char* unit, double value)
{
    std::printf("%s,%s,%.6g\n", name.c_str(), unit, value);
    std::fflush(stdout);
}

template <class T>
T must(Result<T> result)
{
    if (result) return result.take();
    std::fprintf(stderr, "bench_bus: %s\n", result.error().text().c_str());
    std::exit(1);
}

link::Session session_of(const std::string& name)
{
    link::SessionOptions options;
    options.server = name;
    return must(link::Session::find(options, Seconds(10)));
}

// ---- A reader in a process of its own: bench_bus --reader NAME SECONDS -------------------------------------------------

struct Seen
{
    double frames = 0, missed = 0, seconds = 0, cpu = 0, age_median = 0, age_999 = 0;
};

int read_frames(const std::string& name, double seconds)
{
    const link::Session session = session_of(name);
    auto reader = must(session.reader<plab_v2_Frame>());
    (void)session.wait(reader, Seconds(5));
    std::vector<double> ages;
    std::uint64_t last = 0, missed = 0;
    const auto begin = Clock::now();
    const std::clock_t cpu = std::clock();
    while (seconds_since(begin) < seconds)
    {
        if (!session.wait(reader, Seconds(0.2))) continue;
        (void)reader.take(
            [&](const plab_v2_Frame& f, const dds_sample_info_t& info)
            {
                if (!info.valid_data) return;
                ages.push_back(static_cast<double>(now_real_ns() - f.stamp_ns) * 1e-3);
                if (last != 0) missed += f.sequence_number - last - 1;
                last = f.sequence_number;
            });
    }
    const double used = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
    std::printf("%zu %" PRIu64 " %.9g %.9g %.9g %.9g\n", ages.size(), missed, seconds_since(begin), used, quantile(ages, 0.5),
                quantile(ages, 0.999));
    return 0;
}

std::string self;

Process reader(const std::string& name, double seconds) { return Process({self, "--reader", name, std::to_string(seconds)}); }

Seen result_of(Process& process)
{
    (void)process.wait(Milliseconds(60000));
    Seen seen;
    if (std::sscanf(process.output().c_str(), "%lf %lf %lf %lf %lf %lf", &seen.frames, &seen.missed, &seen.seconds, &seen.cpu,
                    &seen.age_median, &seen.age_999) != 6)
        std::fprintf(stderr, "bench_bus: the reader failed: %s\n", process.errors().c_str());
    return seen;
}

// ---- Servers -----------------------------------------------------------------------------------------------------------

struct Server
{
    Server(const std::string& scene, std::vector<std::string> options)
        : name(unique_name("bench")), process(command(scene, name, std::move(options)))
    {
        if (process.wait_for("ready after", Milliseconds(20000))) return;
        std::fprintf(stderr, "bench_bus: no server: %s\n", process.errors().c_str());
        std::exit(1);
    }
    ~Server()
    {
        process.signal(15);
        (void)process.wait(Milliseconds(5000));
    }
    static std::vector<std::string> command(const std::string& scene, const std::string& name, std::vector<std::string> options)
    {
        std::vector<std::string> out{program("plabd"), scene, "--name", name};
        out.insert(out.end(), options.begin(), options.end());
        return out;
    }
    std::string name;
    Process process;
};

/// Bodies that only move: publishing is measured, not the physics.
std::string moving_bodies(int side)
{
    const std::string file = scratch_file("moving_" + std::to_string(side * side) + ".xml");
    std::ofstream(file)
        << "<plab version=\"1\"><scene dt=\"1/60\"/><component id=\"s\" type=\"Shape/Sphere\" radius=\"0.1\"/><repeat id=\"all\" count=\""
        << side << " " << side << "\" step=\"1 1 0\"><component id=\"b\" type=\"State/Kinematic\" shape=\"s\" angular_velocity=\"0 0 1\"/>"
        << "</repeat></plab>";
    return file;
}

void frames_at_60_hz(const char* what, int side)
{
    Server server(moving_bodies(side), {"--rate", "real", "--states", "all"});
    std::this_thread::sleep_for(Milliseconds(1000));
    const double idle_from = cpu_seconds(server.process.pid());
    std::this_thread::sleep_for(Milliseconds(4000));
    const double idle = (cpu_seconds(server.process.pid()) - idle_from) / 4;
    Process process = reader(server.name, 5);
    std::this_thread::sleep_for(Milliseconds(1000));
    const double from = cpu_seconds(server.process.pid());
    std::this_thread::sleep_for(Milliseconds(4000));
    const double busy = (cpu_seconds(server.process.pid()) - from) / 4;
    const Seen seen = result_of(process);
    const std::string stem = std::string("frames_60hz_") + what;
    print(stem + "_per_second", "1/s", seen.frames / seen.seconds);
    print(stem + "_server_cpu_per_frame", "us", (busy - idle) / (seen.frames / seen.seconds) * 1e6);
    print(stem + "_reader_cpu_per_frame", "us", seen.cpu / seen.frames * 1e6);
    print(stem + "_age_median", "us", seen.age_median);
    print(stem + "_missed", "1", seen.missed);
}

void frames_at_most(const char* what, int side)
{
    Server server(moving_bodies(side), {"--rate", "max", "--states", "all"});
    Process process = reader(server.name, 5);
    const Seen seen = result_of(process);
    const std::string stem = std::string("frames_max_") + what;
    print(stem + "_per_second", "1/s", seen.frames / seen.seconds);
    print(stem + "_missed", "1", seen.missed);
}

/// The paper's scene at 1 kHz.
std::string paper_at_1_khz()
{
    std::ifstream in(scene_file("fan_and_balloons.xml"));
    std::string text((std::istreambuf_iterator<char>(in)), {});
    const std::size_t at = text.find("dt=\"1/240\"");
    if (at == std::string::npos) std::exit(1);
    text.replace(at, 10, "dt=\"1/1000\"");
    const std::string file = scratch_file("paper_1khz.xml");
    std::ofstream(file) << text;
    return file;
}

void latency_at_1_khz()
{
    Server server(paper_at_1_khz(), {"--rate", "real", "--states", "all"});
    Process process = reader(server.name, 8);
    const Seen seen = result_of(process);
    print("states_1khz_per_second", "1/s", seen.frames / seen.seconds);
    print("states_1khz_step_to_subscriber_median", "us", seen.age_median);
    print("states_1khz_step_to_subscriber_99.9", "us", seen.age_999);
    print("states_1khz_missed", "1", seen.missed);
}

void swaps_at_1_khz()
{
    Server server(paper_at_1_khz(), {"--rate", "real"});
    const link::Session session = session_of(server.name);
    link::Caller caller = must(link::Caller::make(session, Seconds(5)));
    std::vector<double> round_trip, pause;
    for (int i = 0; i < 2000; ++i)
    {
        const char* const type = i % 2 == 0 ? "Constraint/AngularVelocity/Impulse" : "Constraint/AngularVelocity/Graph";
        const auto begin = Clock::now();
        const link::Reply reply = must(caller.call({{{"swap", "gears", type}}, {}, {}}, Seconds(5)));
        if (!reply.done()) std::exit(1);
        round_trip.push_back(seconds_since(begin) * 1e6);
        pause.push_back(reply.pause_ns * 1e-3);
        std::this_thread::sleep_for(std::chrono::microseconds(700));
    }
    print("swap_request_to_reply_median", "us", quantile(round_trip, 0.5));
    print("swap_request_to_reply_99.9", "us", quantile(round_trip, 0.999));
    print("swap_pause_median", "us", quantile(pause, 0.5));
    print("swap_pause_99.9", "us", quantile(pause, 0.999));
}

void start()
{
    std::vector<double> times;
    link::SessionOptions any;
    for (int i = 0; i < 9; ++i)
    {
        any.server = unique_name("start");
        const link::Session session = must(link::Session::join(any));
        const auto begin = Clock::now();
        Process server(Server::command(scene_file("fan_and_balloons.xml"), any.server, {}));
        if (session.servers(Seconds(10), 1).empty()) std::exit(1);
        times.push_back(seconds_since(begin) * 1e3);
        server.signal(15);
        (void)server.wait(Milliseconds(5000));
    }
    print("start_to_seen_by_a_client_median", "ms", quantile(times, 0.5));
}

double steps_per_second(link::Caller& caller)
{
    const auto step_now = [&] { return must(caller.call({{{"rate", "", "max"}}, {}, {}}, Seconds(5))).step; };
    const std::int64_t from = step_now();
    const auto begin = Clock::now();
    std::this_thread::sleep_for(Milliseconds(1000));
    return static_cast<double>(step_now() - from) / seconds_since(begin);
}

void observers()
{
    Server server(scene_file("fan_and_balloons.xml"), {"--rate", "max"});
    const link::Session session = session_of(server.name);
    link::Caller caller = must(link::Caller::make(session, Seconds(5)));
    std::map<std::string, std::vector<double>> rates;
    for (int round = 0; round < 7; ++round)
    {
        // A reset: each measurement is of the same part of the run.
        const auto measure = [&](const char* what)
        {
            (void)must(caller.call({{{"reset"}}, {}, {}}, Seconds(5)));
            rates[what].push_back(steps_per_second(caller));
        };
        measure("none");
        Process one = reader(server.name, 20);
        (void)one.wait(Milliseconds(400));
        measure("one");
        one.signal(19);
        measure("one_stopped");
        one.signal(18), one.signal(9);
        (void)one.wait(Milliseconds(2000));
    }
    for (const auto& [what, values] : rates) print("steps_per_second_observers_" + what, "1/s", quantile(values, 0.5));
    print("step_time_change_with_a_stopped_observer", "%", (quantile(rates["none"], 0.5) / quantile(rates["one_stopped"], 0.5) - 1) * 100);
}

}  // namespace

int main(int argc, char** argv)
{
    self = argv[0];
    if (argc == 4 && std::string(argv[1]) == "--reader") return read_frames(argv[2], std::atof(argv[3]));
    frames_at_60_hz("1000", 32);
    frames_at_60_hz("10000", 100);
    frames_at_most("1000", 32);
    frames_at_most("10000", 100);
    latency_at_1_khz();
    swaps_at_1_khz();
    start();
    observers();
    return 0;
}
