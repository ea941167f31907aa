/// plabd on this machine, started by plabctl.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "link/session.h"
#include "plab/result.h"
#include "program/child.h"

namespace plab::cli
{

/// plabd beside this program, or the one that PATH finds: a server that ends with this program, and logs to its standard error.
Result<program::Child> start_attached_server(const std::vector<std::string>& arguments);

/// Starts an independent server: a session of its own, no terminal, its log in `log`. Returns the process id.
Result<int> start_server(const std::vector<std::string>& arguments, const std::string& log);
/// Whether it still runs; its exit code if not.
struct Life
{
    bool runs = false;
    int code = 0;
};
Life life_of(int process);

/// Runs plabd to its end with this program's own output; returns the exit code, or 128 + the signal that ended it. When `stop`
/// returns true, it is asked to end, and waited for.
Result<int> run_plabd(const std::vector<std::string>& arguments, const link::Stop& stop);

/// A temporary file of this process, removed with the object.
class TemporaryFile
{
public:
    static Result<TemporaryFile> write(const std::uint8_t* data, std::size_t size);
    TemporaryFile(TemporaryFile&& other) noexcept : path_(std::exchange(other.path_, {})) {}
    TemporaryFile& operator=(TemporaryFile&&) = delete;
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile();
    const std::string& path() const { return path_; }

private:
    explicit TemporaryFile(std::string path) : path_(std::move(path)) {}
    std::string path_;
};

}  // namespace plab::cli
