/// Where a recording's bytes go.
#pragma once

#include <cstdint>
#include <string>

#include "idl/recording/records.h"
#include "plab/result.h"

namespace plab::recording
{

/// A file that grows. Used by one thread. Tests have sinks that fail.
class Sink
{
public:
    virtual ~Sink() = default;
    /// All of `bytes`, or an error; then some of them may have been written: truncate() before anything else is appended.
    virtual Result<void> append(ByteView bytes) = 0;
    /// Cuts off what follows the first `size` bytes, and goes on there.
    virtual Result<void> truncate(std::uint64_t size) = 0;
    /// Returns when what was appended is on the disk (fdatasync).
    virtual Result<void> sync() = 0;
    /// Nothing may be called afterwards. Some file systems tell only now that a write failed.
    virtual Result<void> close() = 0;
};

enum class Overwrite : std::uint8_t
{
    No,   ///< a file that is there already is an error
    Yes,  ///< it is emptied
};

/// A file by its name. Errors name it, with what the system said: "run.mcap: cannot write: No space left on device".
class FileSink final : public Sink
{
public:
    static Result<FileSink> open(const std::string& path, Overwrite overwrite = Overwrite::No);
    FileSink(FileSink&& other) noexcept;
    FileSink& operator=(FileSink&&) = delete;
    FileSink(const FileSink&) = delete;
    FileSink& operator=(const FileSink&) = delete;
    ~FileSink() override;

    Result<void> append(ByteView bytes) override;
    Result<void> truncate(std::uint64_t size) override;
    Result<void> sync() override;
    Result<void> close() override;

private:
    FileSink(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}
    Error failed(const char* what) const;

    int descriptor_ = -1;
    std::string path_;
};

}  // namespace plab::recording
