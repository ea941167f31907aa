/// Saves what can be proved good of a recording that was cut or damaged: chunks and attachments by their CRC, metadata by
/// its seal. Trusts no index, no header and no length that it can do without.
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
    SomethingLost,  ///< or it cannot be told, because the file was not closed
    NothingUsable,
};
/// What a program that recovers a file returns: 0, 5, 1.
int exit_code(Verdict verdict);

struct RecoveryReport
{
    Verdict verdict = Verdict::NothingUsable;
    std::uint64_t chunks = 0;                      ///< that were good
    std::uint64_t messages = 0;                    ///< in the new file
    std::uint64_t undeclared = 0;                  ///< messages of good chunks that were lost with the declarations of their channels
    std::map<std::string, std::uint64_t> kept;     ///< messages by topic
    std::map<std::string, std::uint64_t> missing;  ///< messages by topic, if the file's own statistics are whole
    bool knows_missing = false;                    ///< they are
    std::optional<std::uint64_t> from;             ///< log_time of the first and the last message that were kept
    std::optional<std::uint64_t> to;
    std::uint64_t attachments = 0;
    std::uint64_t metadata = 0;
    std::uint64_t unproved = 0;  ///< records that were kept, though no CRC or seal vouches for them (others' writers)
    std::vector<LostPart> lost;
    std::vector<std::string> mended;  ///< what was wrong and costs nothing: indexes, times in headers
    bool was_closed = false;

    /// Something may be missing behind the last message, and nobody knows until when: the file was not closed.
    bool knows_no_end() const;
    /// A few lines for people: what was kept, what is lost, from when to when.
    std::string text() const;
};

/// Metadata of a file that was made of one of which something was lost: `report` is text(), `messages` how many were kept.
inline constexpr const char* kRecovery = "recovery";

using SinkMaker = std::function<Result<std::unique_ptr<Sink>>()>;

/// Reads `in`, writes a new whole file with what is good; asks for its sink only if there is something. Records of later
/// versions of MCAP are not copied. An error: `in` is no recording at all, or cannot be read, or `out` not be written.
Result<RecoveryReport> recover(const Source& in, const SinkMaker& make_out, const Limits& limits = {});
/// As above, by names. After an error no new file is left; an end that `watch` wants is one. It reads the file twice.
Result<RecoveryReport> recover(const std::string& in, const std::string& out, Overwrite overwrite = Overwrite::No,
                               const Limits& limits = {}, const Watch& watch = {});

}  // namespace plab::recording
