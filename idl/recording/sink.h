/// The destination of a recording's bytes.
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
    /// Appends all of `bytes`, or returns an error; then a part may have been written: call truncate() before anything else is
    /// appended.
    virtual Result<void> append(ByteView bytes) = 0;
    /// Removes everything after the first `size` bytes, and continues there.
    virtual Result<void> truncate(std::uint64_t size) = 0;
    /// Returns when the appended data are on the disk (fdatasync).
    virtual Result<void> sync() = 0;
    /// No function may be called afterwards. Some file systems report a failed write only now.
    virtual Result<void> close() = 0;
};

enum class Overwrite : std::uint8_t
{
    No,   ///< an existing file is an error
    Yes,  ///< an existing file is emptied
};

/// A file by its name. Errors name it, with the system's message: "run.mcap: cannot write: No space left on device".
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
