// What contacts cost the step thread when somebody reads them (plab/contacts), and when nobody does: build/bin/bench_contacts prints the
// table of server/docs/bus.md. Steps with and without notes take turns, so that the load of the machine meets both. Not a test.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "publish/contacts.h"
#include "support/gravity.h"
#include "support/ground.h"
#include "support/load.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// us, processor time of this thread.
double now_us()
{
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> v)
{
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
}

/// Stacks of at most five cubes on level ground.
std::string scene(int count, const std::string& manager)
{
    std::string out = std::string(kGravity) + kGround + "<component id=\"cube\" type=\"Shape/Box\" half_extents=\"0.25 0.25 0.25\"/>";
    for (int k = 0; k < count; ++k)
    {
        const int stack = k / 5;
        const Vec3 at{1.0 * (stack % 50), 1.0 * (stack / 50), 0.25 + 0.5 * (k % 5)};
        out += "<component id=\"c" + std::to_string(k) + "\" type=\"State/RigidBody\" shape=\"cube\" mass=\"1\" position=\"" + text(at) +
               "\"/>";
    }
    return out + "<component id=\"manager\" " + manager +
           "/><component id=\"contact\" type=\"CDetection/ODE\" between=\"*\" resolution=\"Resolution/None\" response=\"Response/Rows\" "
           "response.manager=\"manager\" response.friction=\"0.6\"/>";
}

void measure(int count, const std::string& manager, int steps)
{
    simulation::Simulation s(library());
    if (auto loaded = compile_text(whole_scene(scene(count, manager), "dt=\"1/240\"")); !loaded || !s.load(*loaded))
    {
        std::fprintf(stderr, "bench_contacts: the scene of %d bodies cannot be loaded\n", count);
        return;
    }
    const int warm = manager.find("sleep") == std::string::npos ? 60 : 400;
    for (int i = 0; i < warm; ++i) s.step();
    publish::ContactRecords records;
    wire::ContactForces out;
    std::vector<double> without, with, fill;
    for (int i = 0; i < 2 * steps; ++i)
    {
        const bool notes = i % 2 == 1;
        s.log_contacts(notes);
        const double begin = now_us();
        s.step();
        (notes ? with : without).push_back(now_us() - begin);
        if (!notes) continue;
        const double filled = now_us();
        records.fill(s, out);
        fill.push_back(now_us() - filled);
    }
    std::size_t points = out.left_out;
    for (const wire::ContactInfo& c : out.entries) points += c.points.size();
    const double base = median(without), noted = median(with);
    std::printf("| %d%s | %zu | %.1f us | %.1f us | %.1f us |\n", count, warm > 60 ? ", asleep" : "", points, base, noted - base,
                median(fill));
    std::fflush(stdout);
}

}  // namespace

int main()
{
    std::printf("| bodies | contact points | step | noting, in a step with a sample | the sample |\n|---|---|---|---|---|\n");
    const std::string awake = "type=\"Manager/SoftStep\"";
    measure(1, awake, 2000);
    measure(200, awake, 500);
    measure(10000, awake, 20);
    measure(10000, awake + " sleep_after=\"0.5\"", 50);
    return 0;
}
