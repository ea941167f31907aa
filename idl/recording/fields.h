/// The fields of each record, defined once, in the order of the format, for both writing and reading.
/// fields(visit, record) calls visit(field, ...). Records without a constant layout (messages, chunks, attachments) are handled
/// separately in encode.cpp and parse.cpp.
#pragma once

#include <type_traits>

#include "idl/recording/records.h"

namespace plab::recording
{

/// R is Record, or const Record.
template <class R, class Record>
concept SameRecord = std::is_same_v<std::remove_const_t<R>, Record>;

template <class V, SameRecord<Header> R>
void fields(V&& visit, R& r)
{
    visit(r.profile, r.library);
}

template <class V, SameRecord<Footer> R>
void fields(V&& visit, R& r)
{
    visit(r.summary_start, r.summary_offset_start, r.summary_crc);
}

template <class V, SameRecord<Schema> R>
void fields(V&& visit, R& r)
{
    visit(r.id, r.name, r.encoding, r.data);
}

template <class V, SameRecord<Channel> R>
void fields(V&& visit, R& r)
{
    visit(r.id, r.schema_id, r.topic, r.message_encoding, r.metadata);
}

/// Its data follow, to the end of the record.
template <class V, SameRecord<Message> R>
void fields(V&& visit, R& r)
{
    visit(r.channel, r.sequence, r.log_time, r.publish_time);
}

/// Its records follow, to the end of the record.
template <class V, SameRecord<ChunkHeader> R>
void fields(V&& visit, R& r)
{
    visit(r.start_time, r.end_time, r.uncompressed_size, r.uncompressed_crc, r.compression, r.compressed_size);
}

template <class V, SameRecord<ChunkIndex> R>
void fields(V&& visit, R& r)
{
    visit(r.start_time, r.end_time, r.offset, r.length, r.message_indexes, r.message_index_length, r.compression, r.compressed_size,
          r.uncompressed_size);
}

/// Its data follow, with their length (u64) before and a CRC behind them.
template <class V, SameRecord<Attachment> R>
void fields(V&& visit, R& r)
{
    visit(r.log_time, r.create_time, r.name, r.media_type);
}

template <class V, SameRecord<AttachmentIndex> R>
void fields(V&& visit, R& r)
{
    visit(r.offset, r.length, r.log_time, r.create_time, r.data_size, r.name, r.media_type);
}

template <class V, SameRecord<Metadata> R>
void fields(V&& visit, R& r)
{
    visit(r.name, r.values);
}

template <class V, SameRecord<MetadataIndex> R>
void fields(V&& visit, R& r)
{
    visit(r.offset, r.length, r.name);
}

template <class V, SameRecord<Statistics> R>
void fields(V&& visit, R& r)
{
    visit(r.messages, r.schemas, r.channels, r.attachments, r.metadata, r.chunks, r.start_time, r.end_time, r.channel_messages);
}

template <class V, SameRecord<SummaryOffset> R>
void fields(V&& visit, R& r)
{
    visit(r.group, r.start, r.length);
}

template <class V, SameRecord<DataEnd> R>
void fields(V&& visit, R& r)
{
    visit(r.data_crc);
}

}  // namespace plab::recording
