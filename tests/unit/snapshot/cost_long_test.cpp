// The time that a snapshot takes on the step thread, and the size of its file: a thousand bricks stacked on one another, in contact.
#include <algorithm>
#include <chrono>

#include "simulation/snapshot/format.h"
#include "support/ground.h"
#include "twin.h"

using namespace plab;
using namespace plab::test;

namespace
{

const std::string kThousand = std::string(kGround) +
                              "<component id='brick' type='Shape/Box' half_extents='0.1 0.1 0.1'/>"
                              "<repeat id='bricks' count='10 10 10' step='0.25 0.25 0.2' origin='0 0 0.1'>"
                              "<component id='b' type='State/RigidBody' mass='1' shape='brick'/></repeat>"
                              "<component id='weight' type='Field/Gravity' between='*'/>"
                              "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/None'"
                              " response='Response/Rows' response.friction='0.5'/>";

/// us, the shortest of several times, because other programs on the machine only add to it.
template <class Work>
double shortest(Work work)
{
    double least = 1e300;
    for (int i = 0; i < 20; ++i)
    {
        const auto before = std::chrono::steady_clock::now();
        work();
        least = std::min(least, std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - before).count());
    }
    return least;
}

}  // namespace

TEST_CASE("a capture of a thousand bodies in contact takes less than a millisecond")
{
    const auto s = started(scene_of(kThousand));
    for (int i = 0; i < 30; ++i) s->step();
    simulation::Snapshot snapshot;
    const double capture = shortest([&] { snapshot = s->capture(); });
    const double hash = shortest([&] { CHECK(s->state_hash() == snapshot->state_hash); });
    std::vector<std::uint8_t> bytes;
    const double encode = shortest([&] { bytes = *simulation::encode(snapshot); });
    const double decode = shortest([&] { CHECK(simulation::decode(bytes, library()).ok()); });
    simulation::Simulation twin(library());
    const double restore = shortest([&] { CHECK(twin.restore(snapshot).ok()); });
    const double step = shortest([&] { s->step(); });
    MESSAGE("contact pairs " << snapshot->contacts.pairs.heads.size() << ", points " << snapshot->contacts.pairs.points.size()
                             << "; us: capture " << capture << " (of that the hash " << hash << "), encode " << encode << ", decode "
                             << decode << ", restore " << restore << ", a step " << step << "; file " << bytes.size() << " bytes");
    CHECK(snapshot->contacts.pairs.heads.size() >= 1000);
    CHECK(capture < 1000);
}
