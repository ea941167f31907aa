#include "idl/frame_updates.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace plab::wire
{
namespace
{

// A state is its handle, followed by its numbers.
static_assert(sizeof(plab_v2_BodyState) == sizeof(double) * (1 + kBodyNumbers) && offsetof(plab_v2_BodyState, position) == sizeof(double));
static_assert(offsetof(plab_v2_BodyState, orientation) == 4 * sizeof(double) &&
              offsetof(plab_v2_BodyState, linear_velocity) == 8 * sizeof(double) &&
              offsetof(plab_v2_BodyState, angular_velocity) == 11 * sizeof(double));
static_assert(sizeof(plab_v2_ShaftState) == sizeof(double) * (1 + kShaftNumbers) && offsetof(plab_v2_ShaftState, angle) == sizeof(double) &&
              offsetof(plab_v2_ShaftState, speed) == 2 * sizeof(double));

template <class State>
const std::byte* numbers_of(const State& state)
{
    return reinterpret_cast<const std::byte*>(&state) + sizeof(double);
}

template <class Sequence, class T>
void show(Sequence& out, std::vector<T>& values)
{
    out._maximum = out._length = static_cast<std::uint32_t>(values.size());
    out._buffer = values.data(), out._release = false;
}

}  // namespace

template <std::size_t N, class Sequence>
bool FrameUpdates::has_same_objects(const Rows& rows, const Sequence& states)
{
    if (states._length != rows.handles.size()) return false;
    for (std::size_t i = 0; i < rows.handles.size(); ++i)
        if (states._buffer[i].handle != rows.handles[i]) return false;
    return true;
}

/// Notes what moved since the last frame. Compares raw bits: a number that changed from 0 to -0 has moved.
template <std::size_t N, class Sequence>
void FrameUpdates::compare(Rows& rows, const Sequence& states)
{
    rows.moved_now = 0;
    for (std::size_t i = 0; i < rows.handles.size(); ++i)
    {
        double* const last = rows.numbers.data() + i * N;
        const std::byte* const now = numbers_of(states._buffer[i]);
        if (std::memcmp(last, now, N * sizeof(double)) == 0) continue;
        std::memcpy(last, now, N * sizeof(double));
        ++rows.moved_now;
        rows.count += rows.moved[i] ? 0 : 1;
        rows.moved[i] = true;
    }
}

template <std::size_t N, class Sequence>
void FrameUpdates::take_all(Rows& rows, const Sequence& states)
{
    rows.handles.resize(states._length), rows.numbers.resize(states._length * N);
    rows.moved.assign(states._length, false);
    rows.count = rows.moved_now = 0;
    for (std::size_t i = 0; i < rows.handles.size(); ++i)
    {
        rows.handles[i] = states._buffer[i].handle;
        std::memcpy(rows.numbers.data() + i * N, numbers_of(states._buffer[i]), N * sizeof(double));
    }
}

template <std::size_t N>
void FrameUpdates::select_moved(Rows& rows)
{
    rows.sent_handles.resize(rows.count), rows.sent_numbers.resize(rows.count * N);
    std::size_t place = 0;
    for (std::size_t i = 0; i < rows.handles.size(); ++i)
    {
        if (!rows.moved[i]) continue;
        rows.sent_handles[place] = rows.handles[i];
        std::memcpy(rows.sent_numbers.data() + place * N, rows.numbers.data() + i * N, N * sizeof(double));
        ++place;
    }
}

const plab_v2_FrameUpdate& FrameUpdates::next(const plab_v2_Frame& frame, Clock::time_point now)
{
    out_.run = frame.run, out_.revision = frame.revision, out_.sequence_number = frame.sequence_number;
    out_.step = frame.step, out_.time = frame.time, out_.stamp_ns = frame.stamp_ns;
    if (must_be_key(frame, now))
        make_key(frame, now);
    else
        make_delta();
    return out_;
}

bool FrameUpdates::must_be_key(const plab_v2_Frame& frame, Clock::time_point now)
{
    if (key_is_due_ || frame.run != run_ || frame.revision != revision_ || now - key_time_ >= kLongestBetweenKeys ||
        frame.sequence_number <= key_number_ || !has_same_objects<kBodyNumbers>(bodies_, frame.bodies) ||
        !has_same_objects<kShaftNumbers>(shafts_, frame.shafts))
        return true;
    compare<kBodyNumbers>(bodies_, frame.bodies);
    compare<kShaftNumbers>(shafts_, frame.shafts);
    const std::size_t all = bodies_.handles.size() + shafts_.handles.size();
    const std::size_t sent = bodies_.count + shafts_.count;
    wasted_ += sent - bodies_.moved_now - shafts_.moved_now;
    return sent == all || wasted_ >= all;
}

void FrameUpdates::make_key(const plab_v2_Frame& frame, Clock::time_point now)
{
    take_all<kBodyNumbers>(bodies_, frame.bodies);
    take_all<kShaftNumbers>(shafts_, frame.shafts);
    run_ = frame.run, revision_ = frame.revision, key_number_ = frame.sequence_number, key_time_ = now;
    key_is_due_ = false, wasted_ = 0;
    out_.kind = kKeyFrame, out_.key_number = key_number_;
    show(out_.body_handles, bodies_.handles), show(out_.bodies, bodies_.numbers);
    show(out_.shaft_handles, shafts_.handles), show(out_.shafts, shafts_.numbers);
}

void FrameUpdates::make_delta()
{
    select_moved<kBodyNumbers>(bodies_);
    select_moved<kShaftNumbers>(shafts_);
    out_.kind = kDelta, out_.key_number = key_number_;
    show(out_.body_handles, bodies_.sent_handles), show(out_.bodies, bodies_.sent_numbers);
    show(out_.shaft_handles, shafts_.sent_handles), show(out_.shafts, shafts_.sent_numbers);
}

Result<FrameWriter> FrameWriter::make(const Entity& participant, const Entity& publisher)
{
    auto states = DataWriter<plab_v2_Frame>::make(participant, publisher);
    if (!states) return states.errors();
    auto updates = DataWriter<plab_v2_FrameUpdate>::make(participant, publisher);
    if (!updates) return updates.errors();
    FrameWriter out;
    out.states_ = states.take(), out.updates_ = updates.take();
    return out;
}

dds_return_t FrameWriter::write(const plab_v2_Frame& frame)
{
    dds_return_t code = DDS_RETCODE_OK;
    // Without readers nothing is even encoded.
    if (states_.readers() > 0) code = states_.write(frame);
    const Matched readers = updates_.matched();
    if (readers.ever > std::exchange(seen_, readers.ever)) frames_.restart();
    if (readers.now == 0) return code;
    const dds_return_t updated = updates_.write(frames_.next(frame, FrameUpdates::Clock::now()));
    return code == DDS_RETCODE_OK ? updated : code;
}

Matched FrameWriter::matched() const
{
    const Matched a = states_.matched(), b = updates_.matched();
    return {a.now + b.now, a.ever + b.ever};
}

}  // namespace plab::wire
