/// Finds the intact part of a damaged file: the first half of a recovery. Changes nothing.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "idl/recording/chunk_data.h"
#include "idl/recording/file_index.h"
#include "idl/recording/records.h"
#include "idl/recording/source.h"
#include "plab/result.h"

namespace plab::recording
{

/// An unusable part of the file.
struct LostPart
{
    std::uint64_t begin = 0;  ///< bytes of the file
    std::uint64_t end = 0;
    std::string reason;
    /// It lies between these log_times, as far as its neighbours show: the last before it, the first after it.
    std::optional<std::uint64_t> after;
    std::optional<std::uint64_t> before;
};

/// A record worth keeping.
struct Salvaged
{
    Opcode opcode = Opcode::Chunk;  ///< Chunk, Attachment or Metadata
    std::uint64_t offset = 0;
    std::uint64_t length = 0;  ///< with its record head
};

struct Salvage
{
    Header header;
    std::vector<Salvaged> records;                ///< in file order
    Declarations declarations;                    ///< of intact chunks; missing ones are taken from elsewhere
    std::map<ChannelId, std::uint64_t> messages;  ///< in intact chunks
    std::optional<std::uint64_t> from;            ///< log_time of the first and the last of them
    std::optional<std::uint64_t> to;
    std::vector<LostPart> lost;
    std::vector<std::string> mended;
    std::uint64_t unproved = 0;        ///< number of these records that no CRC or seal protects
    std::optional<FileIndex> summary;  ///< if it is intact
    bool has_end = false;              ///< the data end correctly
    bool is_proved = false;            ///< and the CRC of all of them is correct, or absent
};

Result<Salvage> salvage(const Source& source, const Limits& limits);

}  // namespace plab::recording
