/// Samples of the wire's types as bytes and back: XCDR1 with its 4 bytes of encapsulation, as DDS sends them and as recordings
/// store them (message encoding "cdr").
#pragma once

#include <dds/dds.h>

#include <cstring>

#include "idl/recording/records.h"
#include "idl/topics.h"
#include "plab/result.h"

namespace plab::recording
{

/// A C type of plab.h with the memory that it points to. Starts with zeros and empty texts.
template <class T>
class Sample
{
public:
    Sample() { std::memset(&value_, 0, sizeof value_); }
    Sample(const Sample&) = delete;
    Sample& operator=(const Sample&) = delete;
    ~Sample() { dds_sample_free(&value_, wire::topic_of<T>().type, DDS_FREE_CONTENTS); }

    T* operator->() { return &value_; }
    const T* operator->() const { return &value_; }
    T& operator*() { return value_; }
    const T& operator*() const { return value_; }

private:
    T value_;
};

/// Reuses its buffer: after the first calls it allocates nothing. Little-endian.
class Encoder
{
public:
    Encoder() = default;
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
    ~Encoder();

    /// The bytes are valid until the next call. An error: the sample has a value that its type does not allow.
    template <class T>
    Result<ByteView> encode(const T& sample)
    {
        return encode(&sample, *wire::topic_of<T>().type);
    }
    Result<ByteView> encode(const void* sample, const dds_topic_descriptor_t& type);

private:
    unsigned char* buffer_ = nullptr;  // allocated by Cyclone's allocator, which grows it
    std::uint32_t size_ = 0;
};

/// Reuses its buffer.
class Decoder
{
public:
    /// Fills the sample; its sequences reuse their memory. The bytes are not trusted: data that is truncated, too long, or not
    /// a sample of this type is an error, and the sample stays unchanged. Both byte orders are accepted.
    template <class T>
    Result<void> decode(ByteView bytes, Sample<T>& sample)
    {
        return decode(bytes, &*sample, *wire::topic_of<T>().type);
    }
    /// `sample`: a zeroed sample of this type, or one that was decoded before.
    Result<void> decode(ByteView bytes, void* sample, const dds_topic_descriptor_t& type);

private:
    std::vector<std::uint64_t> aligned_;
};

}  // namespace plab::recording
