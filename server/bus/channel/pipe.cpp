#include "bus/channel/pipe.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>

namespace plab::bus
{
namespace
{

constexpr std::size_t kHead = 4096;  ///< one page for the counters
constexpr std::size_t kAll = kHead + PipeMemory::kDown + PipeMemory::kUp;
constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;
static_assert(2 * sizeof(PipeState) <= kHead);

Error failed(const char* what) { return reason(std::string("cannot share memory with plab-bus: ") + what + ": " + std::strerror(errno)); }

/// Maps the same `bytes` of the file twice in a row; null if that fails.
std::byte* map_twice(int descriptor, std::size_t offset, std::size_t bytes)
{
    void* const place = mmap(nullptr, 2 * bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (place == MAP_FAILED) return nullptr;
    auto* const first = static_cast<std::byte*>(place);
    for (std::byte* at : {first, first + bytes})
        if (mmap(at, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, descriptor, static_cast<off_t>(offset)) == MAP_FAILED)
        {
            (void)munmap(place, 2 * bytes);
            return nullptr;
        }
    return first;
}

}  // namespace

Result<PipeMemory> PipeMemory::make()
{
    PipeMemory memory;
    memory.descriptor_ = memfd_create("plab-bus", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (memory.descriptor_ < 0) return failed("memfd_create");
    if (ftruncate(memory.descriptor_, static_cast<off_t>(kAll)) != 0) return failed("ftruncate");
    // Truncating the file would crash the other process at its next access, so the size is sealed.
    if (fcntl(memory.descriptor_, F_ADD_SEALS, kSeals) != 0) return failed("seals");
    if (auto mapped = memory.map(memory.descriptor_); !mapped) return mapped.errors();
    new (memory.states_) PipeState[2];
    return memory;
}

Result<PipeMemory> PipeMemory::attach(int descriptor)
{
    PipeMemory memory;
    // Only memory made by make() has this size permanently.
    struct stat found
    {
    };
    if (fcntl(descriptor, F_GET_SEALS) != kSeals || fstat(descriptor, &found) != 0 || found.st_size != static_cast<off_t>(kAll))
        return reason("no memory is shared here");
    if (auto mapped = memory.map(descriptor); !mapped) return mapped.errors();
    return memory;
}

Result<void> PipeMemory::map(int descriptor)
{
    void* const head = mmap(nullptr, kHead, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    if (head == MAP_FAILED) return failed("mmap");
    states_ = static_cast<PipeState*>(head);
    down_ = map_twice(descriptor, kHead, kDown);
    up_ = down_ == nullptr ? nullptr : map_twice(descriptor, kHead + kDown, kUp);
    if (up_ == nullptr) return failed("mmap");
    return {};
}

PipeMemory::PipeMemory(PipeMemory&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      states_(std::exchange(other.states_, nullptr)),
      down_(std::exchange(other.down_, nullptr)),
      up_(std::exchange(other.up_, nullptr))
{
}

PipeMemory::~PipeMemory()
{
    if (states_ != nullptr) (void)munmap(states_, kHead);
    if (down_ != nullptr) (void)munmap(down_, 2 * kDown);
    if (up_ != nullptr) (void)munmap(up_, 2 * kUp);
    if (descriptor_ >= 0) (void)close(descriptor_);
}

std::optional<std::span<std::byte>> PipeWriter::room()
{
    const std::uint64_t read = state_->read.load(std::memory_order_acquire);
    if (read < seen_ || read > written_) return std::nullopt;
    seen_ = read;
    return std::span(bytes_.data() + written_ % bytes_.size(), bytes_.size() - static_cast<std::size_t>(written_ - read));
}

void PipeWriter::commit(std::size_t bytes)
{
    written_ += bytes;
    state_->written.store(written_, std::memory_order_release);
}

std::optional<std::span<const std::byte>> PipeReader::waiting()
{
    const std::uint64_t written = state_->written.load(std::memory_order_acquire);
    if (written < seen_ || written - read_ > bytes_.size()) return std::nullopt;
    seen_ = written;
    return std::span(bytes_.data() + read_ % bytes_.size(), static_cast<std::size_t>(written - read_));
}

bool PipeReader::release(std::size_t bytes)
{
    read_ += bytes;
    state_->read.store(read_, std::memory_order_seq_cst);
    return state_->wants_room.load(std::memory_order_seq_cst) != 0 && state_->wants_room.exchange(0, std::memory_order_seq_cst) != 0;
}

}  // namespace plab::bus
