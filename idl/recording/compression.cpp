#include "idl/recording/compression.h"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>

namespace plab::recording
{
namespace
{

LZ4F_preferences_t lz4_preferences(std::size_t size)
{
    LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
    preferences.frameInfo.contentSize = size;
    preferences.frameInfo.blockSizeID = LZ4F_max4MB;
    preferences.autoFlush = 1;
    return preferences;
}

Error failed(std::string_view what, const char* why) { return reason(std::string(what) + ": " + why); }

/// Largest number of bytes to which `in` can decompress.
std::uint64_t most_decompressed(Compression compression, ByteView in)
{
    constexpr std::uint64_t kMostOfLz4 = 256, kMostOfZstd = 65536;  // per byte: runs of one value in the largest blocks
    if (compression == Compression::None) return in.size();
    if (compression == Compression::Lz4) return in.size() * kMostOfLz4;
    const unsigned long long size = ZSTD_getFrameContentSize(in.data(), in.size());
    if (size == ZSTD_CONTENTSIZE_ERROR) return 0;
    return size == ZSTD_CONTENTSIZE_UNKNOWN ? in.size() * kMostOfZstd : size;
}

}  // namespace

std::string_view name_of(Compression compression)
{
    switch (compression)
    {
        case Compression::Lz4:
            return "lz4";
        case Compression::Zstd:
            return "zstd";
        case Compression::None:
            break;
    }
    return "";
}

std::optional<Compression> compression_of(std::string_view name)
{
    for (const Compression c : {Compression::None, Compression::Lz4, Compression::Zstd})
        if (name_of(c) == name) return c;
    return std::nullopt;
}

Result<Compression> parse_compression(std::string_view word)
{
    if (word == "none") return Compression::None;
    if (const auto found = compression_of(word); found && *found != Compression::None) return *found;
    return reason("'" + std::string(word) + "' is not a compression: use none, lz4 or zstd");
}

void Compressor::FreeZstd::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }
void Compressor::FreeLz4::operator()(LZ4F_cctx_s* context) const { (void)LZ4F_freeCompressionContext(context); }
void Decompressor::FreeZstd::operator()(ZSTD_DCtx_s* context) const { ZSTD_freeDCtx(context); }
void Decompressor::FreeLz4::operator()(LZ4F_dctx_s* context) const { (void)LZ4F_freeDecompressionContext(context); }

Compressor::Compressor(Compression compression, int level) : compression_(compression), level_(level) {}

Result<void> Compressor::compress(ByteView in, Bytes& out)
{
    switch (compression_)
    {
        case Compression::Zstd:
            return compress_zstd(in, out);
        case Compression::Lz4:
            return compress_lz4(in, out);
        case Compression::None:
            break;
    }
    out.assign(in.begin(), in.end());
    return {};
}

Result<void> Compressor::compress_zstd(ByteView in, Bytes& out)
{
    if (!zstd_) zstd_.reset(ZSTD_createCCtx());
    if (!zstd_) return reason("zstd: no memory");
    out.resize(ZSTD_compressBound(in.size()));
    const std::size_t n = ZSTD_compressCCtx(zstd_.get(), out.data(), out.size(), in.data(), in.size(), level_);
    if (ZSTD_isError(n) != 0) return failed("zstd", ZSTD_getErrorName(n));
    out.resize(n);
    return {};
}

Result<void> Compressor::compress_lz4(ByteView in, Bytes& out)
{
    if (!lz4_)
    {
        LZ4F_cctx* context = nullptr;
        if (LZ4F_isError(LZ4F_createCompressionContext(&context, LZ4F_VERSION)) != 0) return reason("lz4: no memory");
        lz4_.reset(context);
    }
    const LZ4F_preferences_t preferences = lz4_preferences(in.size());
    out.resize(LZ4F_HEADER_SIZE_MAX + LZ4F_compressBound(in.size(), &preferences));
    std::size_t at = 0;
    const auto step = [&](std::size_t n)
    {
        if (LZ4F_isError(n) != 0) return false;
        at += n;
        return true;
    };
    const bool done = step(LZ4F_compressBegin(lz4_.get(), out.data(), out.size(), &preferences)) &&
                      step(LZ4F_compressUpdate(lz4_.get(), out.data() + at, out.size() - at, in.data(), in.size(), nullptr)) &&
                      step(LZ4F_compressEnd(lz4_.get(), out.data() + at, out.size() - at, nullptr));
    if (!done) return reason("lz4: cannot compress");
    out.resize(at);
    return {};
}

Result<void> Decompressor::decompress(Compression compression, ByteView in, std::uint64_t size, Bytes& out)
{
    // An impossible size is refused before memory is allocated for it.
    const std::uint64_t bound = most_decompressed(compression, in);
    if (size > bound) return reason(std::to_string(in.size()) + " bytes cannot hold " + std::to_string(size));
    out.resize(size);
    switch (compression)
    {
        case Compression::Zstd:
            return decompress_zstd(in, out);
        case Compression::Lz4:
            return decompress_lz4(in, out);
        case Compression::None:
            break;
    }
    if (in.size() != size) return reason("uncompressed records of " + std::to_string(in.size()) + " bytes, not " + std::to_string(size));
    std::copy(in.begin(), in.end(), out.begin());
    return {};
}

Result<void> Decompressor::decompress_zstd(ByteView in, Bytes& out)
{
    if (!zstd_) zstd_.reset(ZSTD_createDCtx());
    if (!zstd_) return reason("zstd: no memory");
    const std::size_t n = ZSTD_decompressDCtx(zstd_.get(), out.data(), out.size(), in.data(), in.size());
    if (ZSTD_isError(n) != 0) return failed("zstd", ZSTD_getErrorName(n));
    if (n != out.size()) return reason("zstd: " + std::to_string(n) + " bytes, not " + std::to_string(out.size()));
    return {};
}

Result<void> Decompressor::decompress_lz4(ByteView in, Bytes& out)
{
    LZ4F_dctx* context = nullptr;
    if (!lz4_)
    {
        if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) return reason("lz4: no memory");
        lz4_.reset(context);
    }
    LZ4F_resetDecompressionContext(lz4_.get());
    std::size_t read = 0, written = 0, hint = 1;
    while (read < in.size() && hint != 0)
    {
        std::size_t n_in = in.size() - read, n_out = out.size() - written;
        hint = LZ4F_decompress(lz4_.get(), out.data() + written, &n_out, in.data() + read, &n_in, nullptr);
        if (LZ4F_isError(hint) != 0) return failed("lz4", LZ4F_getErrorName(hint));
        if (n_in == 0 && n_out == 0) return reason("lz4: more bytes than the chunk says");
        read += n_in;
        written += n_out;
    }
    if (hint != 0 || read != in.size() || written != out.size()) return reason("lz4: the frame does not end where the chunk does");
    return {};
}

}  // namespace plab::recording
