/// The positions of everything in a file: from its summary, or from a scan that reads lengths and skips the rest.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "idl/recording/chunk_data.h"
#include "idl/recording/records.h"
#include "idl/recording/source.h"
#include "plab/result.h"

namespace plab::recording
{

/// Channels, ascending.
using ChannelSet = std::vector<ChannelId>;

/// Sets of channels, each stored once: a file has a million chunks, but only few different sets.
class ChannelSets
{
public:
    /// Its number. An empty set means "unknown".
    std::uint32_t number_of(const ChannelSet& channels);
    const ChannelSet& at(std::uint32_t number) const { return sets_[number]; }

private:
    std::vector<ChannelSet> sets_;
    std::map<ChannelSet, std::uint32_t> numbers_;
};

/// A chunk, and which channels have messages in it.
struct ChunkPlace
{
    std::uint64_t start_time = 0;
    std::uint64_t end_time = 0;
    std::uint64_t offset = 0;
    std::uint64_t compressed_size = 0;
    std::uint64_t uncompressed_size = 0;
    std::uint32_t channels = 0;  ///< of FileIndex::channel_sets
};

struct FileIndex
{
    Header header;
    Declarations declarations;
    std::vector<ChunkPlace> chunks;            ///< by start_time, then offset
    std::vector<std::uint64_t> latest_before;  ///< latest end_time of chunks[0] to chunks[i]
    ChannelSets channel_sets;
    std::vector<AttachmentIndex> attachments;
    std::vector<MetadataIndex> metadata;
    Statistics statistics;
    bool is_closed = false;       ///< has the ending of a closed file
    bool has_summary = false;     ///< read from the file's summary; otherwise from a scan
    std::vector<Error> troubles;  ///< damage that was noticed; a truncated file has none

    bool may_hold(const ChunkPlace& chunk, const std::set<ChannelId>& wanted) const;
    /// Sorts the chunks; call it when all are added.
    void sort_chunks();
};

/// Checks magic and header, and returns the position of the next record.
struct FileStart
{
    Header header;
    std::uint64_t end = 0;
};
Result<FileStart> read_start(const Source& source, const Limits& limits);

/// The footer of a closed file. Empty: the file does not end like one.
Result<std::optional<Footer>> read_footer(const Source& source);
/// CRC of the bytes from `begin` to before `end`.
Result<std::uint32_t> crc_of_range(const Source& source, std::uint64_t begin, std::uint64_t end);
/// Reads the summary that the footer names. An error: it is damaged, its CRC is wrong, or there is none.
Result<FileIndex> read_summary(const Source& source, const Footer& footer, const Limits& limits);

/// Uses the summary if there is a complete one, otherwise a scan. An error: this is not a recording, or cannot be read at all.
/// In a file without a summary, the channels of a chunk are read from records that no CRC covers: readers rely on them,
/// recover() does not.
Result<FileIndex> read_index(const Source& source, const Limits& limits);

}  // namespace plab::recording
