// Writes the golden file of a snapshot format: build/bin/snapshot_golden FILE. A new format gets a file of its own; those of older ones
// are not changed.
#include <cstdio>
#include <fstream>

#include "mixed_scene.h"
#include "simulation/snapshot/format.h"
#include "support/load.h"

int main(int argc, char** argv)
{
    using namespace plab;
    if (argc != 2) return std::fputs("usage: snapshot_golden FILE\n", stderr), 2;
    auto loaded = test::load_text(test::whole_scene(test::kMixed, "dt='1/60'"));
    if (!loaded) return std::fprintf(stderr, "%s\n", loaded.error().text().c_str()), 1;
    simulation::Simulation& s = **loaded;
    for (int i = 0; i < 60; ++i) s.step();
    const simulation::Snapshot snapshot = s.capture();
    for (int i = 0; i < 100; ++i) s.step();
    const std::vector<simulation::SnapshotNote> notes{{"hash at step 160", std::to_string(s.state_hash())}};
    const auto bytes = simulation::encode(snapshot, {}, notes);
    if (!bytes) return std::fprintf(stderr, "%s\n", bytes.error().text().c_str()), 1;
    std::ofstream out(argv[1], std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes->data()), static_cast<std::streamsize>(bytes->size()));
    out.close();
    return out.good() ? 0 : 1;
}
