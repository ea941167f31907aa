#include "replay/divergence.h"

#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstring>

#include "model/numbers.h"
#include "model/values.h"
#include "publish/states.h"
#include "simulation/snapshot/format.h"

namespace plab::replay
{
namespace
{

/// Largest number of differences shown, of each kind.
constexpr std::size_t kMost = 5;

template <class T>
bool same_bits(const T& a, const T& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

void compare_body(const std::string& id, const wire::BodyState& was, const wire::BodyState& is, std::vector<simulation::Difference>& out)
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

/// Steps up to `step`, carrying out the recorded requests on the way.
Result<void> go_to(Tick step, simulation::Simulation& s, const std::function<Result<void>()>& ask)
{
    while (s.tick() < step)
    {
        if (auto asked = ask(); !asked) return asked;
        if (!s.step_once()) return reason("abandoned at step " + std::to_string(s.tick()) + ": the replay is to end");
    }
    return {};
}

/// The first one at that step or later; null if there is none.
const record::RecordedSnapshot* snapshot_after(const record::RunLog& log, const Mismatch& mismatch)
{
    const record::RecordedSnapshot* next = nullptr;
    for (const record::RecordedSnapshot& s : log.snapshots())
        if (s.run == mismatch.run && s.step >= mismatch.step && (!next || s.step < next->step)) next = &s;
    return next;
}

Result<void> compare_with_frame(record::RunLog& log, const wire::Frame& frame, const simulation::Simulation& s, Mismatch& mismatch)
{
    mismatch.frame_step = frame.step, mismatch.recorded_revision = frame.revision;
    auto objects = log.objects(mismatch.run);
    if (!objects) return objects.errors();
    const world::HostTables& host = s.world().host();
    for (const auto& [handle, id] : *objects)
    {
        const std::uint32_t i = s.world().find(id);
        if (i == kNoIndex) continue;
        const world::Component& c = s.world().component(i);
        for (const wire::BodyState& b : frame.bodies)
            if (b.handle == handle && c.facet == Facet::Body)
                compare_body(id, b, publish::state_of(host.bodies, c.host_index, handle), mismatch.in_frame);
        for (const wire::ShaftState& shaft : frame.shafts)
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

Result<void> compare_with_snapshot(record::RunLog& log, const record::RecordedSnapshot& next, const simulation::Simulation& s,
                                   model::TypeSource& types, Mismatch& mismatch)
{
    auto recorded = log.read(next);
    if (!recorded) return recorded.errors();
    auto decoded = simulation::decode(recorded->data, types);
    if (!decoded) return decoded.errors();
    simulation::Comparison how;
    how.most = kMost;
    mismatch.snapshot_step = next.step;
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
    const record::RecordedSnapshot* const next = snapshot_after(log, mismatch);
    auto frame = log.frame(mismatch.run, mismatch.step);
    if (!frame) return frame.errors();
    if (*frame && (!next || (*frame)->step <= next->step))
    {
        const std::uint64_t revision = simulation.revision();
        if (auto gone = go_to((*frame)->step, simulation, ask); !gone) return gone;
        mismatch.replayed_revision += simulation.revision() - revision;
        if (auto done = compare_with_frame(log, **frame, simulation, mismatch); !done) return done;
    }
    if (!next) return {};
    if (auto gone = go_to(next->step, simulation, ask); !gone) return gone;
    return compare_with_snapshot(log, *next, simulation, types, mismatch);
}

std::string Mismatch::text() const
{
    std::array<char, 200> head{};
    (void)std::snprintf(head.data(), head.size(),
                        "run %" PRIu64 ", step %" PRId64 ": recorded hash %016" PRIx64 ", replayed %016" PRIx64 "\n", run, step, recorded,
                        replayed);
    std::string out = head.data();
    if (recorded_revision > replayed_revision)
        out += "until then " + std::to_string(recorded_revision - replayed_revision) +
               " more changes of the scene took effect than the journal contains: it lacks requests\n";
    const std::string where =
        frame_step == step ? "the recorded frame of that step" : "the recorded frame of step " + std::to_string(frame_step);
    if (frame_step >= 0 && in_frame.empty())
        out += where +
               " is identical: the difference is in data that frames do not contain (contacts, the state of a script or coupling), or the "
               "hash in the file "
               "is wrong\n";
    else if (frame_step >= 0)
        out += "in " + where + ":\n";
    for (const simulation::Difference& d : in_frame) add(out, d);
    if (snapshot_step >= 0)
        out += in_snapshot.empty() ? "the snapshot of step " + std::to_string(snapshot_step) + " is identical again\n"
                                   : "in the snapshot of step " + std::to_string(snapshot_step) + ":\n";
    for (const simulation::Difference& d : in_snapshot) add(out, d);
    if (frame_step < 0 && snapshot_step < 0)
        out +=
            "the recording has neither a frame nor a snapshot of that step or later: it is not known what differs; record every step "
            "(without --record-states) and snapshots more often (--record-snapshots), or compare the columns of --trace\n";
    return out;
}

}  // namespace plab::replay
