/// Moves bytes between two processes through shared memory, one pipe per direction. Neither end waits for the other, and
/// neither trusts what the other may write: apart from the bytes, only the two counters are shared, and each end keeps a
/// private copy of its own counter.
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

/// What both ends share for one direction.
struct PipeState
{
    alignas(64) std::atomic<std::uint64_t> written{0};  ///< total bytes written; owned by the producer
    alignas(64) std::atomic<std::uint64_t> read{0};     ///< total bytes read; owned by the consumer
    std::atomic<std::uint32_t> wants_room{0};           ///< the producer has more data: notify when there is room
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free);

/// The shared memory of both directions. Each ring is mapped twice in a row, so that any range of a ring is contiguous in
/// memory.
class PipeMemory
{
public:
    static constexpr std::size_t kDown = 4u << 20, kUp = 1u << 20;  ///< bytes from plabd to plab-bus, and back

    /// Makes new shared memory; its size is sealed and cannot be changed afterwards.
    static Result<PipeMemory> make();
    /// Maps the memory behind a descriptor, which stays the caller's.
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

    /// The free part of the ring, where to write next; empty if the other end's counter is invalid.
    std::optional<std::span<std::byte>> room();
    /// Reports that `bytes` of room() were filled.
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

    /// The bytes to read; empty if the other end's counter is invalid.
    std::optional<std::span<const std::byte>> waiting();
    /// Releases `bytes` of waiting(). True if the producer waits for room.
    bool release(std::size_t bytes);

private:
    PipeState* state_;
    std::span<const std::byte> bytes_;
    std::uint64_t read_ = 0, seen_ = 0;
};

}  // namespace plab::bus
