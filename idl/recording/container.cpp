#include "idl/recording/container.h"

#include "idl/recording/crc.h"
#include "idl/recording/encode.h"

namespace plab::recording
{
namespace
{

Error in_doubt() { return reason("the end of the file is in doubt after a failed write"); }

}  // namespace

Result<Container> Container::begin(std::unique_ptr<Sink> sink, const Header& header, std::size_t most_index_memory)
{
    Container out(std::move(sink), most_index_memory);
    put_bytes(out.scratch_, kMagic);
    append(out.scratch_, header);
    if (auto done = out.append_whole(out.scratch_); !done) return done.errors();
    return out;
}

Result<void> Container::append_whole(ByteView bytes)
{
    if (is_damaged_) return in_doubt();
    if (auto done = sink_->append(bytes); !done)
    {
        is_damaged_ = true;
        return done;
    }
    crc_ = crc_onwards(crc_, bytes);
    size_ += bytes.size();
    return {};
}

Result<void> Container::put_chunk(ByteView bytes, ChunkIndex index, const ChunkContents& contents)
{
    const std::uint64_t begin = size_;
    if (auto done = append_whole(bytes); !done) return done;
    index.offset += begin;
    for (auto& [channel, offset] : index.message_indexes) offset += begin;
    return summary_.add(index, contents);
}

Result<void> Container::put(const Attachment& attachment)
{
    scratch_.clear();
    append(scratch_, attachment);
    const std::uint64_t begin = size_;
    if (auto done = append_whole(scratch_); !done) return done;
    summary_.add(AttachmentIndex{begin, scratch_.size(), attachment.log_time, attachment.create_time, attachment.data.size(),
                                 attachment.name, attachment.media_type});
    return {};
}

Result<void> Container::put(const Metadata& metadata)
{
    scratch_.clear();
    append(scratch_, metadata);
    const std::uint64_t begin = size_;
    if (auto done = append_whole(scratch_); !done) return done;
    summary_.add(MetadataIndex{begin, scratch_.size(), metadata.name});
    return {};
}

Result<void> Container::repair()
{
    if (!is_damaged_) return {};
    if (auto done = sink_->truncate(size_); !done) return done;
    is_damaged_ = false;
    return {};
}

Result<void> Container::finish()
{
    auto done = is_damaged_ ? Result<void>(in_doubt()) : write_end();
    // A partial summary would look like damage; without any, the file merely counts as not closed.
    Errors errors = done.errors();
    const auto collect = [&](const Result<void>& result) { errors.insert(errors.end(), result.errors().begin(), result.errors().end()); };
    if (!errors.empty()) collect(sink_->truncate(size_));
    collect(sink_->close());
    sink_.reset();
    return errors;
}

Result<void> Container::write_end()
{
    scratch_.clear();
    append(scratch_, DataEnd{crc_});
    if (auto done = sink_->append(scratch_); !done) return done;
    if (auto done = summary_.write(*sink_, size_ + scratch_.size()); !done) return done;
    return sink_->sync();
}

}  // namespace plab::recording
