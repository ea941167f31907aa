#include "replay/divergence.h"

#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstring>

#include "model/values.h"
#include "publish/states.h"
#include "simulation/snapshot/format.h"

namespace plab::replay
{
namespace
{

/// Differences that are shown, of each kind.
constexpr std::size_t kMost = 5;

template <class T>
bool same_bits(const T& a, const T& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

void compare_body(const std::string& id, const publish::BodyState& was, const publish::BodyState& is,
                  std::vector<simulation::Difference>& out)
{
    const auto compare = [&](const char* field, const auto& recorded, const auto& replayed)
    {
        if (same_bits(recorded, replayed) || out.size() >= kMost) return;
        out.push_back({id, field, model::format_value(recorded), model::format_value(replayed)});
    };
    compare("position", was.position, is.position);
    compare("orientation", was.orientation, is.orientation);
    compare("linear_velocity", was.linear_velocity, is.linear_velocity);
    compare("angular_velocity", was.angular_velocity, is.angular_velocity);
}

Result<void> compare_with_frame(record::RunLog& log, const simulation::Simulation& s, Mismatch& mismatch)
{
    auto frame = log.frame(mismatch.run, mismatch.step);
    if (!frame) return frame.errors();
    if (!*frame) return {};
    auto objects = log.objects(mismatch.run);
    if (!objects) return objects.errors();
    const world::HostTables& host = s.world().host();
    for (const auto& [handle, id] : *objects)
    {
        const std::uint32_t i = s.world().find(id);
        if (i == kNoIndex) continue;
        const world::Component& c = s.world().component(i);
        for (const publish::BodyState& b : (*frame)->bodies)
            if (b.handle == handle && c.facet == Facet::Body)
                compare_body(id, b, publish::state_of(host.bodies, c.host_index, handle), mismatch.in_frame);
        for (const publish::ShaftState& shaft : (*frame)->shafts)
        {
            if (shaft.handle != handle || c.facet != Facet::Shaft) continue;
            const auto compare = [&, &id = id](const char* field, double recorded, double replayed)
            {
                if (!same_bits(recorded, replayed) && mismatch.in_frame.size() < kMost)
                    mismatch.in_frame.push_back({id, field, model::format_real(recorded), model::format_real(replayed)});
            };
            compare("angle", shaft.angle, host.shafts.angle[c.host_index]);
            compare("angular_velocity", shaft.speed, host.shafts.speed[c.host_index]);
        }
    }
    return {};
}

Result<void> compare_with_snapshot(record::RunLog& log, simulation::Simulation& s, model::TypeSource& types, Mismatch& mismatch,
                                   const std::function<Result<void>()>& ask)
{
    const record::RecordedSnapshot* next = nullptr;
    for (const record::RecordedSnapshot& candidate : log.snapshots())
        if (candidate.run == mismatch.run && candidate.step >= s.tick() && (!next || candidate.step < next->step)) next = &candidate;
    if (!next) return {};
    while (s.tick() < next->step)
    {
        if (auto asked = ask(); !asked) return asked;
        s.step_once();
    }
    auto recorded = log.read(*next);
    if (!recorded) return recorded.errors();
    auto decoded = simulation::decode(recorded->data, types);
    if (!decoded) return decoded.errors();
    simulation::Comparison how;
    how.most = kMost;
    mismatch.snapshot_step = next->step;
    mismatch.in_snapshot = simulation::differences(*decoded->snapshot, *s.capture(), how);
    return {};
}

void add(std::string& text, const simulation::Difference& d)
{
    text += "  " + d.component + (d.component.empty() ? "" : ".") + d.field + ": recorded " + d.first + ", replayed " + d.second + "\n";
}

}  // namespace

Result<void> find_differences(record::RunLog& log, simulation::Simulation& simulation, model::TypeSource& types, Mismatch& mismatch,
                              const std::function<Result<void>()>& ask)
{
    if (auto done = compare_with_frame(log, simulation, mismatch); !done) return done;
    return compare_with_snapshot(log, simulation, types, mismatch, ask);
}

std::string Mismatch::text() const
{
    std::array<char, 200> head{};
    (void)std::snprintf(head.data(), head.size(),
                        "run %" PRIu64 ", step %" PRId64 ": recorded hash %016" PRIx64 ", replayed %016" PRIx64 "\n", run, step, recorded,
                        replayed);
    std::string out = head.data();
    if (!in_frame.empty()) out += "in the recorded frame of that step:\n";
    for (const simulation::Difference& d : in_frame) add(out, d);
    if (snapshot_step >= 0)
        out += in_snapshot.empty() ? "the snapshot of step " + std::to_string(snapshot_step) + " is the same again\n"
                                   : "in the snapshot of step " + std::to_string(snapshot_step) + ":\n";
    for (const simulation::Difference& d : in_snapshot) add(out, d);
    if (in_frame.empty() && snapshot_step < 0)
        out += "the recording has neither a frame of that step nor a later snapshot: it cannot be told what differs\n";
    return out;
}

}  // namespace plab::replay
