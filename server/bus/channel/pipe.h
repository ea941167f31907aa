/// Bytes from one process to another through shared memory, in one direction each. Neither end waits for the other, and
/// neither believes what the other may write: the two counters are all that is shared beside the bytes, and each end keeps
/// its own one to itself.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "plab/result.h"

namespace plab::bus
{

/// What both ends see of one direction.
struct PipeState
{
    alignas(64) std::atomic<std::uint64_t> written{0};  ///< bytes, ever; the producer's
    alignas(64) std::atomic<std::uint64_t> read{0};     ///< bytes, ever; the consumer's
    std::atomic<std::uint32_t> wants_room{0};           ///< the producer has more: ring when there is room
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free);

/// The shared memory of both directions. The bytes of each are mapped twice in a row: whatever lies in a ring lies in one piece.
class PipeMemory
{
public:
    static constexpr std::size_t kDown = 4u << 20, kUp = 1u << 20;  ///< bytes from plabd to plab-bus, and back

    /// A new one; its size can be changed by nobody any more.
    static Result<PipeMemory> make();
    /// The one behind a descriptor, which stays the caller's.
    static Result<PipeMemory> attach(int descriptor);
    PipeMemory(PipeMemory&& other) noexcept;
    PipeMemory& operator=(PipeMemory&& other) = delete;
    PipeMemory(const PipeMemory&) = delete;
    PipeMemory& operator=(const PipeMemory&) = delete;
    ~PipeMemory();

    int descriptor() const { return descriptor_; }
    PipeState& down_state() const { return states_[0]; }
    PipeState& up_state() const { return states_[1]; }
    std::span<std::byte> down() const { return {down_, kDown}; }
    std::span<std::byte> up() const { return {up_, kUp}; }

private:
    PipeMemory() = default;
    Result<void> map(int descriptor);

    int descriptor_ = -1;
    PipeState* states_ = nullptr;
    std::byte *down_ = nullptr, *up_ = nullptr;
};

class PipeWriter
{
public:
    PipeWriter(PipeState& state, std::span<std::byte> bytes) : state_(&state), bytes_(bytes) {}

    /// Where to write next, as much as there is room for; nothing if the other end's counter cannot be true.
    std::optional<std::span<std::byte>> room();
    /// `bytes` of room() were filled.
    void commit(std::size_t bytes);
    void ask_for_room() { state_->wants_room.store(1, std::memory_order_seq_cst); }

private:
    PipeState* state_;
    std::span<std::byte> bytes_;
    std::uint64_t written_ = 0, seen_ = 0;
};

class PipeReader
{
public:
    PipeReader(PipeState& state, std::span<const std::byte> bytes) : state_(&state), bytes_(bytes) {}

    /// What there is to read; nothing if the other end's counter cannot be true.
    std::optional<std::span<const std::byte>> waiting();
    /// `bytes` of waiting() are done with. True if the producer waits for room.
    bool release(std::size_t bytes);

private:
    PipeState* state_;
    std::span<const std::byte> bytes_;
    std::uint64_t read_ = 0, seen_ = 0;
};

}  // namespace plab::bus
