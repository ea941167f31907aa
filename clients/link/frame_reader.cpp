#include "link/frame_reader.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "idl/frame_updates.h"

namespace plab::link
{
namespace
{

template <std::size_t N, class Handles, class Numbers>
bool fit_together(const Handles& handles, const Numbers& numbers)
{
    return numbers._length == std::uint64_t{handles._length} * N;
}

template <std::size_t N, class State, class Numbers>
void set(State& state, std::uint32_t handle, const Numbers& numbers, std::size_t row)
{
    static_assert(sizeof(State) == (1 + N) * sizeof(double));
    state.handle = handle;
    std::memcpy(reinterpret_cast<std::byte*>(&state) + sizeof(double), numbers._buffer + row * N, N * sizeof(double));
}

template <std::size_t N, class State, class Handles, class Numbers>
void fill(std::vector<State>& states, const Handles& handles, const Numbers& numbers)
{
    states.resize(handles._length);
    for (std::size_t i = 0; i < states.size(); ++i) set<N>(states[i], handles._buffer[i], numbers, i);
}

/// The rows of a delta are in the order of the key frame. False: one of them is not in it.
template <std::size_t N, class State, class Handles, class Numbers>
bool replace(std::vector<State>& states, const Handles& handles, const Numbers& numbers)
{
    auto at = states.begin();
    for (std::size_t i = 0; i < handles._length; ++i, ++at)
    {
        at = std::find_if(at, states.end(), [&](const State& state) { return state.handle == handles._buffer[i]; });
        if (at == states.end()) return false;
        set<N>(*at, handles._buffer[i], numbers, i);
    }
    return true;
}

template <class Sequence, class State>
void show(Sequence& out, std::vector<State>& states)
{
    out._maximum = out._length = static_cast<std::uint32_t>(states.size());
    out._buffer = states.data(), out._release = false;
}

}  // namespace

const plab_v2_Frame* FrameAssembler::add(const plab_v2_FrameUpdate& update)
{
    const bool is_valid = fit_together<wire::kBodyNumbers>(update.body_handles, update.bodies) &&
                          fit_together<wire::kShaftNumbers>(update.shaft_handles, update.shafts);
    // A key frame always counts: a server that was started again counts from 1.
    const bool is_done = is_valid && (update.kind == wire::kKeyFrame ? begin(update) : put(update));
    if (!is_done) return ++incomplete_, nullptr;
    last_ = update.sequence_number;
    out_.run = update.run, out_.revision = update.revision, out_.sequence_number = update.sequence_number;
    out_.step = update.step, out_.time = update.time, out_.stamp_ns = update.stamp_ns;
    show(out_.bodies, bodies_), show(out_.shafts, shafts_);
    return &out_;
}

bool FrameAssembler::begin(const plab_v2_FrameUpdate& key)
{
    fill<wire::kBodyNumbers>(bodies_, key.body_handles, key.bodies);
    fill<wire::kShaftNumbers>(shafts_, key.shaft_handles, key.shafts);
    key_ = key.sequence_number;
    return has_key_ = true;
}

bool FrameAssembler::put(const plab_v2_FrameUpdate& delta)
{
    if (!has_key_ || delta.key_number != key_ || delta.sequence_number <= last_) return false;
    // Rows that moved once are in all later deltas of the same key frame: lost deltas leave nothing behind.
    has_key_ = replace<wire::kBodyNumbers>(bodies_, delta.body_handles, delta.bodies) &&
               replace<wire::kShaftNumbers>(shafts_, delta.shaft_handles, delta.shafts);
    return has_key_;
}

Result<FrameReader> FrameReader::open(const Session& session)
{
    auto reader = session.reader<plab_v2_FrameUpdate>();
    if (!reader) return reader.errors();
    FrameReader out;
    out.reader_ = reader.take();
    return out;
}

/// DDS hands over the key frames first and then the deltas, since they are two instances; their order is that in which they were written.
dds_return_t FrameReader::take_updates(const Use& use)
{
    constexpr std::size_t kMost = 64;  // DDS keeps four of each kind and writer
    std::array<void*, kMost> samples{};
    std::array<dds_sample_info_t, kMost> infos;
    const dds_return_t n = dds_take(reader_.entity().get(), samples.data(), infos.data(), kMost, kMost);
    if (n <= 0) return n;
    std::vector<std::pair<dds_time_t, const plab_v2_FrameUpdate*>> order;
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
        if (infos[i].valid_data) order.emplace_back(infos[i].source_timestamp, static_cast<const plab_v2_FrameUpdate*>(samples[i]));
    const auto earlier = [](const auto& a, const auto& b)
    { return a.first != b.first ? a.first < b.first : a.second->sequence_number < b.second->sequence_number; };
    std::sort(order.begin(), order.end(), earlier);
    std::vector<const plab_v2_FrameUpdate*> updates;
    for (const auto& [written, update] : order) updates.push_back(update);
    use(updates);
    (void)dds_return_loan(reader_.entity().get(), samples.data(), n);
    return n;
}

}  // namespace plab::link
