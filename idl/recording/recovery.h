/// Saves the provably intact part of a truncated or damaged recording: chunks and attachments by their CRC, metadata by its
/// seal. Relies as little as possible on indexes, headers and lengths.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "idl/recording/chunk_data.h"
#include "idl/recording/salvage.h"
#include "idl/recording/sink.h"
#include "idl/recording/source.h"
#include "plab/result.h"

namespace plab::recording
{

enum class Verdict : std::uint8_t
{
    Whole,          ///< nothing is missing
    SomethingLost,  ///< or this is unknown, because the file was not closed
    NothingUsable,
};
/// The exit code of a program that recovers a file: 0, 5, 1.
int exit_code(Verdict verdict);

struct RecoveryReport
{
    Verdict verdict = Verdict::NothingUsable;
    std::uint64_t chunks = 0;      ///< intact chunks
    std::uint64_t messages = 0;    ///< in the new file
    std::uint64_t undeclared = 0;  ///< messages of intact chunks that were lost because the declarations of their channels were
    std::map<std::string, std::uint64_t> kept;     ///< messages by topic
    std::map<std::string, std::uint64_t> missing;  ///< messages by topic, if the file's own statistics are intact
    bool knows_missing = false;                    ///< whether they are
    std::optional<std::uint64_t> from;             ///< log_time of the first and the last message that were kept
    std::optional<std::uint64_t> to;
    std::uint64_t attachments = 0;
    std::uint64_t metadata = 0;
    std::uint64_t unproved = 0;  ///< records that were kept although no CRC or seal protects them (of other writers)
    std::vector<LostPart> lost;
    std::vector<std::string> mended;  ///< damage that costs nothing: indexes, times in headers
    bool was_closed = false;

    /// Something may be missing after the last message, up to an unknown time, because the file was not closed.
    bool knows_no_end() const;
    /// A few lines for people: what was kept, what is lost, and which times are affected.
    std::string text() const;
};

/// Metadata of a file that was made from a damaged one: `report` is text(), `messages` the number of kept messages.
inline constexpr const char* kRecovery = "recovery";

using SinkMaker = std::function<Result<std::unique_ptr<Sink>>()>;

/// Reads `in`, and writes a new complete file with the intact data; requests its sink only if there is something to write.
/// Records of later versions of MCAP are not copied. An error: `in` is not a recording or cannot be read, or `out` cannot be
/// written.
Result<RecoveryReport> recover(const Source& in, const SinkMaker& make_out, const Limits& limits = {});
/// As above, with file names. After an error, including an interruption by `watch`, no new file is left. Reads the file twice.
Result<RecoveryReport> recover(const std::string& in, const std::string& out, Overwrite overwrite = Overwrite::No,
                               const Limits& limits = {}, const Watch& watch = {});

}  // namespace plab::recording
