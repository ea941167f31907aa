/// Raw bytes of values, for mementos and hashes. Valid within one build only; files use a format of their own.
#pragma once

#include <cassert>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "plab/value.h"

namespace plab
{

/// A growing buffer of bytes. clear() keeps the memory, so a memento that is in use does not allocate.
class ByteWriter
{
public:
    void clear() { bytes_.clear(); }
    void raw(const void* data, std::size_t n)
    {
        const auto* p = static_cast<const std::uint8_t*>(data);
        bytes_.insert(bytes_.end(), p, p + n);
    }
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }

private:
    std::vector<std::uint8_t> bytes_;
};

/// Reads what a ByteWriter wrote, in the same order.
class ByteReader
{
public:
    explicit ByteReader(const std::vector<std::uint8_t>& bytes) : bytes_(&bytes) {}
    void raw(void* data, std::size_t n)
    {
        assert(at_ + n <= bytes_->size());
        std::memcpy(data, bytes_->data() + at_, n);
        at_ += n;
    }
    bool at_end() const { return at_ == bytes_->size(); }

private:
    const std::vector<std::uint8_t>* bytes_;
    std::size_t at_ = 0;
};

template <class T>
requires std::is_trivially_copyable_v<T>
void write(ByteWriter& out, const T& v) { out.raw(&v, sizeof v); }
template <class T>
requires std::is_trivially_copyable_v<T>
void read(ByteReader& in, T& v) { in.raw(&v, sizeof v); }

inline void write(ByteWriter& out, const std::string& v)
{
    write(out, v.size());
    out.raw(v.data(), v.size());
}
inline void read(ByteReader& in, std::string& v)
{
    std::size_t n = 0;
    read(in, n);
    v.resize(n);
    in.raw(v.data(), n);
}
template <class T>
requires std::is_trivially_copyable_v<T>
void write(ByteWriter& out, const std::vector<T>& v)
{
    write(out, v.size());
    out.raw(v.data(), v.size() * sizeof(T));
}
template <class T>
requires std::is_trivially_copyable_v<T>
void read(ByteReader& in, std::vector<T>& v)
{
    std::size_t n = 0;
    read(in, n);
    v.resize(n);
    in.raw(v.data(), n * sizeof(T));
}
inline void write(ByteWriter& out, const Entries& v)
{
    write(out, v.size());
    for (const Entry& e : v)
    {
        write(out, e.name);
        write(out, e.value.index());
        if (const auto* b = std::get_if<bool>(&e.value)) write(out, *b);
        if (const auto* d = std::get_if<double>(&e.value)) write(out, *d);
        if (const auto* s = std::get_if<std::string>(&e.value)) write(out, *s);
    }
}
inline void read(ByteReader& in, Entries& v)
{
    std::size_t n = 0;
    read(in, n);
    v.resize(n);
    for (Entry& e : v)
    {
        std::size_t kind = 0;
        read(in, e.name);
        read(in, kind);
        bool b = false;
        double d = 0;
        std::string s;
        if (kind == 0) read(in, b), e.value = b;
        if (kind == 1) read(in, d), e.value = d;
        if (kind == 2) read(in, s), e.value = s;
    }
}

}  // namespace plab
