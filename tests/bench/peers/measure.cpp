#include "bench/peers/measure.h"

#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <sstream>

namespace plab::peers
{
namespace
{

double seconds_of(clockid_t clock)
{
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Sums the times between start and stop, by both clocks.
class Stopwatch
{
public:
    void start() { cpu_ -= seconds_of(CLOCK_PROCESS_CPUTIME_ID), wall_ -= seconds_of(CLOCK_MONOTONIC); }
    void stop() { wall_ += seconds_of(CLOCK_MONOTONIC), cpu_ += seconds_of(CLOCK_PROCESS_CPUTIME_ID); }
    double cpu() const { return cpu_; }
    double wall() const { return wall_; }

private:
    double cpu_ = 0, wall_ = 0;  // s
};

double resident_megabytes()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

int steps_in(double duration, const Step& step) { return std::max(1, static_cast<int>(std::lround(duration / step.seconds()))); }

int stride_of(const Case& which, const Step& step, int total)
{
    const auto of_rate = [&step](double rate) { return std::max(1, static_cast<int>(std::lround(1 / (rate * step.seconds())))); };
    switch (which.sampling)
    {
        case Sampling::EveryStep:
            return 1;
        case Sampling::Rate30:
            return of_rate(30);
        case Sampling::Rate60:
            return of_rate(60);
        case Sampling::End:
            return total;
    }
    return 1;
}

Stopwatch time_loop(const Run& run, const Scene& scene, Engine& engine)
{
    Stopwatch watch;
    watch.start();
    engine.advance(steps_in(scene.duration, run.step));
    watch.stop();
    return watch;
}

Stopwatch record(const Case& which, const Run& run, const Scene& scene, Engine& engine, Trace& trace)
{
    const int total = steps_in(scene.duration, run.step), stride = stride_of(which, run.step, total);
    trace.bodies = scene.bodies.size();
    Stopwatch watch;
    for (int done = 0; done < total;)
    {
        const int n = std::min(stride, total - done);
        watch.start();
        engine.advance(n);
        watch.stop();
        done += n;
        trace.time.push_back(static_cast<double>(done) * run.step.num / run.step.den);
        trace.states.resize(trace.size() * trace.bodies);
        engine.read({trace.states.data() + (trace.size() - 1) * trace.bodies, trace.bodies});
    }
    return watch;
}

struct Outbox
{
    std::string text;
    void say(const std::string& line) { text += line + "\n"; }
    void say(const char* key, double value)
    {
        char line[64];
        std::snprintf(line, sizeof line, "%s %.17g", key, value);
        say(std::string(line));
    }
};

/// The largest of two figures, where "not a number" is the worst of all.
double worse(double a, double b) { return std::isnan(a) || std::isnan(b) ? std::nan("") : std::fmax(a, b); }

constexpr double kLong = 0.5;    // s: longer loops are timed once, by the processor clock
constexpr double kPiece = 1e-3;  // s
constexpr double kEnough = 0.4;  // s, of repetitions
constexpr int kLeastLoops = 3, kMostLoops = 20;

/// s per loop, warm: the sum over pieces of each piece's least time; see measure.h.
Result<double> time_warm(const Run& run, const Scene& scene, double about)
{
    const int total = steps_in(scene.duration, run.step);
    const int pieces = std::clamp(static_cast<int>(about / kPiece), 1, total);
    std::vector<double> least(static_cast<std::size_t>(pieces), 1e300);
    const double end = seconds_of(CLOCK_MONOTONIC) + kEnough;
    for (int loops = 1; loops <= kMostLoops && (loops <= kLeastLoops || seconds_of(CLOCK_MONOTONIC) < end); ++loops)
    {
        auto engine = run.make(scene);
        if (!engine) return engine.errors();
        for (int i = 0, done = 0; i < pieces; ++i)
        {
            const int next = static_cast<int>(static_cast<std::int64_t>(total) * (i + 1) / pieces);
            Stopwatch watch;
            watch.start();
            (*engine)->advance(next - done);
            watch.stop();
            least[static_cast<std::size_t>(i)] = std::fmin(least[static_cast<std::size_t>(i)], watch.wall());
            done = next;
        }
    }
    double sum = 0;
    for (const double t : least) sum += t;
    return sum;
}

Result<void> run_scene(const Case& which, const Run& run, const Scene& scene, Quantity quantity, std::vector<double>& figures, double& cost)
{
    auto engine = run.make(scene);
    if (!engine) return engine.errors();
    Stopwatch watch;
    if (quantity == Quantity::Figures)
    {
        Trace trace;
        watch = record(which, run, scene, **engine, trace);
        const std::vector<double> f = which.measure(scene, trace);
        if (figures.empty()) figures = f;
        for (std::size_t i = 0; i < f.size(); ++i) figures[i] = worse(figures[i], f[i]);
    }
    else
        watch = time_loop(run, scene, **engine);
    double spent = watch.cpu();
    if (spent < kLong)
    {
        const auto warm = time_warm(run, scene, std::fmin(watch.wall(), spent + 0.01));
        if (!warm) return warm.errors();
        spent = *warm;
    }
    cost += spent * 1e3 / scene.duration / static_cast<double>(which.scenes.size());
    return {};
}

void work(const Case& which, const Run& run, Quantity quantity, Outbox& out)
{
    const double born = resident_megabytes();
    std::vector<double> figures;
    double cost = 0;
    for (const Scene& scene : which.scenes)
        if (const auto done = run_scene(which, run, scene, quantity, figures, cost); !done)
            return out.say("refused " + done.error().text());
    for (const double f : figures) out.say("figure", f);
    out.say("cost", cost);
    out.say("memory", resident_megabytes() - born);
    out.say("done");
}

[[noreturn]] void be_child(int to, const Case& which, const Run& run, Quantity quantity)
{
    const auto seconds = static_cast<rlim_t>(std::ceil(which.cpu_limit * static_cast<double>(which.scenes.size()))) + 1;
    const rlimit limit{seconds, seconds + 1}, no_core{0, 0};
    setrlimit(RLIMIT_CPU, &limit);
    setrlimit(RLIMIT_CORE, &no_core);
    if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(2);  // engines that complain at each step
    Outbox out;
    try
    {
        work(which, run, quantity, out);
    }
    catch (const std::exception& e)  // Simbody's report of a failed step
    {
        out.say("threw " + std::string(e.what(), 0, std::string(e.what()).find('\n')));
    }
    std::size_t sent = 0;
    while (sent < out.text.size())
    {
        const ssize_t n = ::write(to, out.text.data() + sent, out.text.size() - sent);
        if (n <= 0) break;
        sent += static_cast<std::size_t>(n);
    }
    _exit(0);  // no destructors: a large world takes long to take apart
}

/// Reads until the child closes its end; false if that takes longer than `limit` seconds.
bool read_all(int from, double limit, std::string& text)
{
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(limit);
    char buffer[4096];
    while (Clock::now() < end)
    {
        pollfd waiting{from, POLLIN, 0};
        if (poll(&waiting, 1, 200) <= 0) continue;
        const ssize_t n = ::read(from, buffer, sizeof buffer);
        if (n <= 0) return true;
        text.append(buffer, static_cast<std::size_t>(n));
    }
    return false;
}

Measurement understand(const std::string& text)
{
    Measurement m;
    m.outcome = Outcome::Crashed, m.why = "the process ended without a result";
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
    {
        const std::size_t blank = line.find(' ');
        const std::string key = line.substr(0, blank), value = blank == std::string::npos ? "" : line.substr(blank + 1);
        if (key == "figure") m.figures.push_back(std::strtod(value.c_str(), nullptr));
        if (key == "cost") m.cost = std::strtod(value.c_str(), nullptr);
        if (key == "memory") m.memory = std::strtod(value.c_str(), nullptr);
        if (key == "threw") m.why = value;
        if (key == "refused") m.outcome = Outcome::Refused, m.why = value;
        if (key == "done") m.outcome = Outcome::Done, m.why.clear();
    }
    return m;
}

Measurement failed(Outcome outcome, std::string why)
{
    Measurement m;
    m.outcome = outcome, m.why = std::move(why);
    return m;
}

}  // namespace

const char* name_of(Outcome outcome)
{
    switch (outcome)
    {
        case Outcome::Done:
            return "done";
        case Outcome::Refused:
            return "refused";
        case Outcome::Cut:
            return "cut";
        case Outcome::Crashed:
            return "crashed";
    }
    return "";
}

Measurement measure(const Case& which, const Run& run, Quantity quantity)
{
    int ends[2];
    if (pipe(ends) != 0) return failed(Outcome::Crashed, "no pipe to be had");
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0)
    {
        ::close(ends[0]), ::close(ends[1]);
        return failed(Outcome::Crashed, "no process to be had");
    }
    if (child == 0)
    {
        ::close(ends[0]);
        be_child(ends[1], which, run, quantity);
    }
    ::close(ends[1]);
    std::string text;
    const bool in_time = read_all(ends[0], 8 * which.cpu_limit + 60, text);  // a shared machine may give it little
    ::close(ends[0]);
    if (!in_time) kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    const bool too_long = WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || !in_time);
    if (too_long) return failed(Outcome::Cut, "more than " + std::to_string(static_cast<int>(which.cpu_limit)) + " s of processor time");
    if (WIFSIGNALED(status)) return failed(Outcome::Crashed, std::string("signal ") + std::to_string(WTERMSIG(status)));
    return understand(text);
}

}  // namespace plab::peers
