/// Serializes records: each function appends one complete record. Little-endian.
#pragma once

#include <string_view>
#include <utility>

#include "idl/recording/records.h"

namespace plab::recording
{

void put_u32(Bytes& out, std::uint32_t v);
void put_text(Bytes& out, std::string_view text);
void put_bytes(Bytes& out, ByteView bytes);

void append(Bytes& out, const Header& record);
void append(Bytes& out, const Footer& record);
void append(Bytes& out, const Schema& record);
void append(Bytes& out, const Channel& record);
void append(Bytes& out, const Message& record);
void append(Bytes& out, const ChunkIndex& record);
/// With a CRC of its contents.
void append(Bytes& out, const Attachment& record);
void append(Bytes& out, const AttachmentIndex& record);
void append(Bytes& out, const Statistics& record);
void append(Bytes& out, const Metadata& record);
void append(Bytes& out, const MetadataIndex& record);
void append(Bytes& out, const SummaryOffset& record);
void append(Bytes& out, const DataEnd& record);

/// A chunk; `records` are compressed as the header says, header.compressed_size bytes.
void append_chunk(Bytes& out, const ChunkHeader& header, ByteView records);

/// {log_time, offset in the uncompressed chunk} of each message of one channel, in their order.
using MessageTimes = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
void append_message_index(Bytes& out, ChannelId channel, const MessageTimes& entries);

}  // namespace plab::recording
