/// The source from which a recording is read.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "idl/recording/records.h"
#include "plab/result.h"

namespace plab::recording
{

/// Bytes at offsets. May be used by several threads.
class Source
{
public:
    virtual ~Source() = default;
    /// For messages: a file's name.
    virtual const std::string& name() const = 0;
    /// Number of bytes available now; a file that is being written grows.
    virtual Result<std::uint64_t> size() const = 0;
    /// Fills `into` from `offset` on; fewer bytes only at the end of the source.
    virtual Result<std::size_t> read(std::uint64_t offset, std::span<std::uint8_t> into) const = 0;
};

/// Errors name the file, with the system's message.
class FileSource final : public Source
{
public:
    static Result<FileSource> open(const std::string& path);
    FileSource(FileSource&& other) noexcept;
    FileSource& operator=(FileSource&&) = delete;
    FileSource(const FileSource&) = delete;
    FileSource& operator=(const FileSource&) = delete;
    ~FileSource() override;

    const std::string& name() const override { return path_; }
    Result<std::uint64_t> size() const override;
    Result<std::size_t> read(std::uint64_t offset, std::span<std::uint8_t> into) const override;

private:
    FileSource(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}
    Error failed(const char* what) const;

    int descriptor_ = -1;
    std::string path_;
};

/// Bytes that other code owns.
class MemorySource final : public Source
{
public:
    explicit MemorySource(ByteView bytes, std::string name = "memory") : bytes_(bytes), name_(std::move(name)) {}

    const std::string& name() const override { return name_; }
    Result<std::uint64_t> size() const override { return std::uint64_t{bytes_.size()}; }
    Result<std::size_t> read(std::uint64_t offset, std::span<std::uint8_t> into) const override;

private:
    ByteView bytes_;
    std::string name_;
};

/// Called at each read with the fraction of the source before it, from 0 to 1; return false to stop.
using Watch = std::function<bool(double share)>;

/// A source that reports the progress of reading, and can be stopped: from then on each read is an error. This makes every
/// reader of recordings, with or without an index, interruptible.
class WatchedSource final : public Source
{
public:
    WatchedSource(std::unique_ptr<const Source> source, Watch watch) : source_(std::move(source)), watch_(std::move(watch)) {}

    const std::string& name() const override { return source_->name(); }
    Result<std::uint64_t> size() const override { return source_->size(); }
    Result<std::size_t> read(std::uint64_t offset, std::span<std::uint8_t> into) const override;

private:
    std::unique_ptr<const Source> source_;
    Watch watch_;
};

/// A source with a small window: for many short reads that are close to each other.
class Window
{
public:
    explicit Window(const Source& source) : source_(&source) {}
    /// `n` bytes (at most kMost) at `offset`, or as many as there are. Valid until the next call.
    Result<ByteView> view(std::uint64_t offset, std::size_t n);
    /// As above; fewer bytes are an error.
    Result<ByteView> exactly(std::uint64_t offset, std::size_t n);
    static constexpr std::size_t kMost = 4096;

private:
    const Source* source_;
    Bytes bytes_;
    std::uint64_t begin_ = 0;
};

}  // namespace plab::recording
