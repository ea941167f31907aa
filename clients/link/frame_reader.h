/// Frames of one server, complete, from the key frames and deltas of plab/updates.
///
///   auto frames = link::FrameReader::open(session);
///   while (session.wait(*frames, 1s)) frames->take([](const plab_v2_Frame& f) { ... });
#pragma once

#include <span>

#include "link/session.h"

namespace plab::link
{

/// Makes complete frames of key frames and deltas. What it gets comes from the bus and is checked.
class FrameAssembler
{
public:
    /// The complete frame, valid until the next call. Null: its key frame did not arrive (the next one comes within a second), a
    /// newer frame was returned before, or it is not valid.
    const plab_v2_Frame* add(const plab_v2_FrameUpdate& update);
    /// The last frame that add() returned, valid until the next call; null: none yet.
    const plab_v2_Frame* newest() const { return has_key_ ? &out_ : nullptr; }
    /// Frames that could not be completed.
    std::uint64_t incomplete() const { return incomplete_; }

private:
    bool begin(const plab_v2_FrameUpdate& key);
    bool put(const plab_v2_FrameUpdate& delta);

    std::vector<plab_v2_BodyState> bodies_;  ///< in the order of the key frame
    std::vector<plab_v2_ShaftState> shafts_;
    std::uint64_t key_ = 0, last_ = 0, incomplete_ = 0;  ///< numbers of the key frame and of the last frame
    bool has_key_ = false;
    plab_v2_Frame out_{};
};

class FrameReader
{
public:
    FrameReader() = default;
    static Result<FrameReader> open(const Session& session);

    /// Passes every frame that has arrived and is complete to `handle(const plab_v2_Frame&)`, in their order; returns the number of
    /// samples, or an error code.
    template <class Handle>
    dds_return_t take(Handle&& handle)
    {
        return take_updates(
            [&](std::span<const plab_v2_FrameUpdate* const> updates)
            {
                for (const plab_v2_FrameUpdate* update : updates)
                    if (const plab_v2_Frame* const frame = assembler_.add(*update)) handle(*frame);
            });
    }
    /// The last frame, valid until the next take(); null: none yet.
    const plab_v2_Frame* newest() const { return assembler_.newest(); }
    std::uint64_t incomplete() const { return assembler_.incomplete(); }
    std::uint32_t writers() const { return reader_.writers(); }
    const wire::Entity& entity() const { return reader_.entity(); }

private:
    using Use = std::function<void(std::span<const plab_v2_FrameUpdate* const>)>;
    dds_return_t take_updates(const Use& use);

    wire::DataReader<plab_v2_FrameUpdate> reader_;
    FrameAssembler assembler_;
};

}  // namespace plab::link
