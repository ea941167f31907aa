// Measurements of the bus, not a test. Two processes on loopback:
//
//   bus_traffic read NAME [SECONDS]                        a reader of plab/states; reports what it received when the time is over
//   bus_traffic follow NAME [SECONDS]                      the same by plab/updates
//   bus_traffic write NAME BODIES RATE|max SECONDS [MOVING]  a server's end that writes frames; RATE in Hz; MOVING: of BODIES, all
//   bus_traffic raw NAME BODIES RATE|max SECONDS           the same frames by dds_write alone: the limit of DDS on this machine
//   bus_traffic raw-updates NAME BODIES RATE|max SECONDS   the same, as key frames of plab/updates
//   bus_traffic answer NAME SECONDS                        answers requests at once, like a step loop
//   bus_traffic ask NAME COUNT                             sends COUNT requests, and reports how long replies took
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "bus/server_bus.h"
#include "idl/frame_updates.h"
#include "link/caller.h"
#include "link/frame_reader.h"

using namespace plab;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

namespace
{

double cpu_seconds()
{
    rusage use{};
    (void)getrusage(RUSAGE_SELF, &use);
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    return seconds(use.ru_utime) + seconds(use.ru_stime);
}

/// CPU time of the calling thread, s.
double thread_seconds()
{
    timespec t{};
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::int64_t now_ns()
{
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

double quantile(std::vector<double> values, double q)
{
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

std::uint32_t domain()
{
    const auto options = wire::domain_from_environment();
    return options ? options->id : 0;
}

int fail(const Error& error)
{
    std::fprintf(stderr, "%s\n", error.text().c_str());
    return 1;
}

/// `take(reader, note)` calls note(frame) for each frame that has arrived.
template <class Reader, class Take>
int read(const link::Session& session, Result<Reader> reader, double seconds, Take take)
{
    if (!reader) return fail(reader.error());
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    std::uint64_t frames = 0, first = 0, last = 0;
    std::vector<double> age_us;
    const double cpu = cpu_seconds();
    Clock::time_point began, ended;
    while (Clock::now() < end)
    {
        if (!session.wait(*reader, link::Seconds(0.2))) continue;
        take(*reader,
             [&](const plab_v2_Frame& f)
             {
                 if (frames++ == 0) first = f.sequence_number, began = Clock::now();
                 last = f.sequence_number, ended = Clock::now();
                 age_us.push_back(1e-3 * static_cast<double>(now_ns() - f.stamp_ns));
             });
    }
    const double elapsed = std::chrono::duration<double>(ended - began).count();
    std::printf("read: %lu frames, %lu missed, %.0f frames/s, CPU %.0f us/frame, age p50 %.0f us, p99 %.0f us\n", frames,
                frames ? last - first + 1 - frames : 0, static_cast<double>(frames) / elapsed,
                1e6 * (cpu_seconds() - cpu) / static_cast<double>(std::max<std::uint64_t>(frames, 1)), quantile(age_us, 0.5),
                quantile(age_us, 0.99));
    return 0;
}

int read_states(const std::string& name, double seconds)
{
    auto session = link::Session::join({name, {domain(), ""}});
    if (!session) return fail(session.error());
    const auto take = [](wire::DataReader<plab_v2_Frame>& reader, const auto& note)
    {
        (void)reader.take(
            [&](const plab_v2_Frame& f, const dds_sample_info_t& info)
            {
                if (info.valid_data) note(f);
            });
    };
    return read(*session, session->reader<plab_v2_Frame>(), seconds, take);
}

int read_updates(const std::string& name, double seconds)
{
    auto session = link::Session::join({name, {domain(), ""}});
    if (!session) return fail(session.error());
    const auto take = [](link::FrameReader& reader, const auto& note) { (void)reader.take(note); };
    return read(*session, link::FrameReader::open(*session), seconds, take);
}

Result<std::unique_ptr<bus::ServerBus>> open(const std::string& name)
{
    bus::BusOptions options;
    options.name = name, options.domain = domain();
    return bus::ServerBus::open(options);
}

int write(const std::string& name, std::size_t bodies, std::size_t moving, double rate, double seconds)
{
    auto opened = open(name);
    if (!opened) return fail(opened.error());
    bus::Bus& bus = **opened;
    const auto give_up = Clock::now() + 10s;
    while (!bus.wants(publish::Stream::States) && Clock::now() < give_up) std::this_thread::sleep_for(1ms);
    const auto begin = Clock::now();
    const auto end = begin + std::chrono::duration<double>(seconds);
    const double cpu = cpu_seconds(), own = thread_seconds();
    std::vector<double> push_us;
    std::uint64_t number = 0;
    for (auto next = begin; Clock::now() < end; ++number)
    {
        const auto start = Clock::now();
        wire::Frame& frame = bus.begin_frame();
        frame.sequence_number = number + 1, frame.stamp_ns = now_ns();
        frame.bodies.resize(bodies);
        for (std::size_t i = 0; i < bodies; ++i)
            frame.bodies[i].handle = static_cast<std::uint32_t>(i),
            frame.bodies[i].position.x = i < moving ? static_cast<double>(number) : 0;
        bus.end_frame();
        push_us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
        if (rate > 0)
            std::this_thread::sleep_until(next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate)));
        else
            std::this_thread::sleep_for(50us);  // faster than any reader; without it this thread takes the bus thread's core
    }
    const double producer = thread_seconds() - own, all = cpu_seconds() - cpu;
    bus.status({});
    std::printf("write: %lu frames of %zu bodies, CPU %.0f us/frame (bus and DDS), push p50 %.1f us, p99.9 %.1f us, longest %.1f us\n",
                number, bodies, 1e6 * (all - producer) / static_cast<double>(number), quantile(push_us, 0.5), quantile(push_us, 0.999),
                quantile(push_us, 1));
    return 0;
}

template <class T>
int write_raw(const std::string& name, T& frame, std::size_t bodies, double rate, double seconds)
{
    auto session = link::Session::join({name, {domain(), ""}});
    if (!session) return fail(session.error());
    auto writer = session->writer<T>();
    if (!writer) return fail(writer.error());
    const auto give_up = Clock::now() + 10s;
    while (writer->readers() == 0 && Clock::now() < give_up) std::this_thread::sleep_for(1ms);
    const double cpu = cpu_seconds();
    const auto begin = Clock::now(), end = begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    for (auto next = begin; Clock::now() < end;)
    {
        ++frame.sequence_number, frame.stamp_ns = now_ns();
        if constexpr (requires { frame.key_number; }) frame.key_number = frame.sequence_number;
        (void)writer->write(frame);
        if (rate > 0)
            std::this_thread::sleep_until(next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate)));
    }
    std::printf("raw: %lu frames of %zu bodies, CPU %.0f us/frame\n", frame.sequence_number, bodies,
                1e6 * (cpu_seconds() - cpu) / static_cast<double>(frame.sequence_number));
    return 0;
}

int write_raw_states(const std::string& name, std::size_t bodies, double rate, double seconds)
{
    std::vector<plab_v2_BodyState> states(bodies);
    const auto count = static_cast<std::uint32_t>(bodies);
    plab_v2_Frame frame{};
    frame.bodies = {count, count, states.data(), false};
    return write_raw(name, frame, bodies, rate, seconds);
}

int write_raw_updates(const std::string& name, std::size_t bodies, double rate, double seconds)
{
    std::vector<std::uint32_t> handles(bodies);
    std::vector<double> numbers(bodies * wire::kBodyNumbers);
    const auto count = static_cast<std::uint32_t>(bodies), all = static_cast<std::uint32_t>(numbers.size());
    plab_v2_FrameUpdate update{};
    update.body_handles = {count, count, handles.data(), false}, update.bodies = {all, all, numbers.data(), false};
    return write_raw(name, update, bodies, rate, seconds);
}

int answer(const std::string& name, double seconds)
{
    auto opened = open(name);
    if (!opened) return fail(opened.error());
    bus::Bus& bus = **opened;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    publish::ReceivedRequest request;
    while (Clock::now() < end)
    {
        while (bus.take(request))
        {
            wire::Reply a;
            a.client = request.client, a.number = request.number, a.outcome = "done";
            bus.answer(std::move(a));
        }
        std::this_thread::sleep_for(50us);
    }
    return 0;
}

int ask(const std::string& name, int count)
{
    auto session = link::Session::join({name, {domain(), ""}});
    if (!session) return fail(session.error());
    auto caller = link::Caller::make(*session, link::Seconds(10));
    if (!caller) return fail(caller.error());
    std::vector<double> us;
    for (int i = 0; i < count; ++i)
    {
        const auto start = Clock::now();
        const auto reply = caller->call({{{"pause"}}, std::nullopt, std::nullopt}, link::Seconds(5));
        if (!reply) return fail(reply.error());
        us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    }
    std::printf("ask: %d replies, p50 %.0f us, p99.9 %.0f us, longest %.0f us\n", count, quantile(us, 0.5), quantile(us, 0.999),
                quantile(us, 1));
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    const std::vector<std::string> args(argv + 1, argv + argc);
    if (args.size() >= 2 && args[0] == "read") return read_states(args[1], args.size() > 2 ? std::atof(args[2].c_str()) : 5);
    if (args.size() >= 2 && args[0] == "follow") return read_updates(args[1], args.size() > 2 ? std::atof(args[2].c_str()) : 5);
    if (args.size() >= 5 && (args[0] == "write" || args[0] == "raw" || args[0] == "raw-updates"))
    {
        const auto bodies = static_cast<std::size_t>(std::atol(args[2].c_str()));
        const double rate = args[3] == "max" ? 0 : std::atof(args[3].c_str()), seconds = std::atof(args[4].c_str());
        if (args[0] == "raw") return write_raw_states(args[1], bodies, rate, seconds);
        if (args[0] == "raw-updates") return write_raw_updates(args[1], bodies, rate, seconds);
        const auto moving = args.size() > 5 ? static_cast<std::size_t>(std::atol(args[5].c_str())) : bodies;
        return write(args[1], bodies, moving, rate, seconds);
    }
    if (args.size() == 3 && args[0] == "answer") return answer(args[1], std::atof(args[2].c_str()));
    if (args.size() == 3 && args[0] == "ask") return ask(args[1], std::atoi(args[2].c_str()));
    std::fprintf(stderr,
                 "bus_traffic read|follow NAME [SECONDS] | write NAME BODIES RATE|max SECONDS [MOVING] |\n"
                 "            raw|raw-updates NAME BODIES RATE|max SECONDS | answer NAME SECONDS | ask NAME COUNT\n");
    return 2;
}
