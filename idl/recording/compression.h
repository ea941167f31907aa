/// Compression of chunks. Contexts are reused: after the first calls a compressor allocates nothing.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "idl/recording/records.h"
#include "plab/result.h"

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;
struct LZ4F_cctx_s;
struct LZ4F_dctx_s;

namespace plab::recording
{

enum class Compression : std::uint8_t
{
    None,
    Lz4,  ///< LZ4 frames
    Zstd,
};

/// The name in MCAP: "", "lz4", "zstd".
std::string_view name_of(Compression compression);
/// Empty for any other name.
std::optional<Compression> compression_of(std::string_view name);
/// As users name it: "none", "lz4", "zstd".
Result<Compression> parse_compression(std::string_view word);

class Compressor
{
public:
    /// `level`: of zstd, 1 to 19; higher is smaller and slower. LZ4 has only one.
    Compressor(Compression compression, int level);

    Compression compression() const { return compression_; }
    /// Replaces the contents of `out`. Fails only for lack of memory.
    Result<void> compress(ByteView in, Bytes& out);

private:
    Result<void> compress_zstd(ByteView in, Bytes& out);
    Result<void> compress_lz4(ByteView in, Bytes& out);
    struct FreeZstd
    {
        void operator()(ZSTD_CCtx_s* context) const;
    };
    struct FreeLz4
    {
        void operator()(LZ4F_cctx_s* context) const;
    };

    Compression compression_;
    int level_;
    std::unique_ptr<ZSTD_CCtx_s, FreeZstd> zstd_;
    std::unique_ptr<LZ4F_cctx_s, FreeLz4> lz4_;
};

class Decompressor
{
public:
    /// Replaces the contents of `out`, which must then have `size` bytes; anything else is an error. The caller has limited
    /// `size`.
    Result<void> decompress(Compression compression, ByteView in, std::uint64_t size, Bytes& out);

private:
    Result<void> decompress_zstd(ByteView in, Bytes& out);
    Result<void> decompress_lz4(ByteView in, Bytes& out);
    struct FreeZstd
    {
        void operator()(ZSTD_DCtx_s* context) const;
    };
    struct FreeLz4
    {
        void operator()(LZ4F_dctx_s* context) const;
    };

    std::unique_ptr<ZSTD_DCtx_s, FreeZstd> zstd_;
    std::unique_ptr<LZ4F_dctx_s, FreeLz4> lz4_;
};

}  // namespace plab::recording
