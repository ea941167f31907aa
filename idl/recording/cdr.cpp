#include "idl/recording/cdr.h"

#include <dds/ddsi/ddsi_cdrstream.h>
#include <dds/ddsi/q_protocol.h>
#include <dds/ddsrt/heap.h>

#include <array>
#include <limits>
#include <string>

namespace plab::recording
{
namespace
{

/// Representation identifier (XCDR1 of a @final type, little-endian; big-endian has 0 in the second place), options.
constexpr std::array<std::uint8_t, 4> kEncapsulation{0x00, 0x01, 0x00, 0x00};
/// The stream begins here in the buffer. Fields align by their place in the buffer, and 8 is the largest alignment, so
/// that the encapsulation fits in before it.
constexpr std::uint32_t kStreamBegin = 8;
constexpr std::uint8_t kPaddingBits = 3;

Error refused(const dds_topic_descriptor_t& type, const std::string& why) { return reason(std::string(type.m_typename) + ": " + why); }

}  // namespace

Encoder::~Encoder() { ddsrt_free(buffer_); }

Result<ByteView> Encoder::encode(const void* sample, const dds_topic_descriptor_t& type)
{
    constexpr std::uint32_t kFirst = 1024;
    if (buffer_ == nullptr) buffer_ = static_cast<unsigned char*>(ddsrt_malloc(size_ = kFirst));
    dds_ostreamLE_t stream{{buffer_, size_, kStreamBegin, CDR_ENC_VERSION_1}};
    const auto* done = dds_stream_writeLE(&stream, static_cast<const char*>(sample), type.m_ops);
    buffer_ = stream.x.m_buffer;
    size_ = stream.x.m_size;
    if (done == nullptr) return refused(type, "a value that the type does not allow");
    std::memcpy(buffer_ + kStreamBegin - kEncapsulation.size(), kEncapsulation.data(), kEncapsulation.size());
    return ByteView(buffer_ + kStreamBegin - kEncapsulation.size(), buffer_ + stream.x.m_index);
}

Result<void> Decoder::decode(ByteView bytes, void* sample, const dds_topic_descriptor_t& type)
{
    if (bytes.size() < kEncapsulation.size()) return refused(type, "shorter than its encapsulation");
    if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) return refused(type, "longer than a sample can be");
    if (bytes[0] != 0 || bytes[1] > 1) return refused(type, "an encapsulation other than XCDR1's 0x0000 and 0x0001");
    const bool is_big_endian = bytes[1] == 0;
    const std::size_t padding = bytes[3] & kPaddingBits;
    const ByteView stream = bytes.subspan(kEncapsulation.size());
    if (padding > stream.size()) return refused(type, "more padding than bytes");

    const auto size = static_cast<std::uint32_t>(stream.size() - padding);
    aligned_.resize((size + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t) + 1);
    std::memcpy(aligned_.data(), stream.data(), size);
    std::uint32_t end = 0;
    auto* data = reinterpret_cast<char*>(aligned_.data());
    // Checks every length and value, so that the next call need not.
    if (dds_stream_normalize_data(data, &end, size, is_big_endian, CDR_ENC_VERSION_1, type.m_ops) == nullptr)
        return refused(type, "truncated, or not a sample of this type");
    if (end != size) return refused(type, std::to_string(size - end) + " bytes more than a sample of this type");
    dds_istream_t in;
    dds_istream_init(&in, size, aligned_.data(), CDR_ENC_VERSION_1);
    (void)dds_stream_read(&in, static_cast<char*>(sample), type.m_ops);
    dds_istream_fini(&in);
    return {};
}

}  // namespace plab::recording
