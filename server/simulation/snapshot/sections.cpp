#include "simulation/snapshot/sections.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "world/state_hash.h"
#include "world/world.h"

namespace plab::simulation
{
namespace
{

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

constexpr std::uint64_t kHashStart = 0xcbf29ce484222325ull;
constexpr std::size_t kPreamble = 8 + 4 + 8;  // magic, version, length
constexpr std::size_t kEnding = 8;            // hash

/// The column type of a value, by name; "none" has no column.
std::string_view type_name(const Value& value)
{
    constexpr std::string_view kNames[] = {"none",   "boolean", "integer", "real",     "vector", "rotation",
                                           "matrix", "text",    "reals",   "integers", "entries"};
    static_assert(std::size(kNames) == std::variant_size_v<Value>);
    return kNames[value.index()];
}

class SectionWriter
{
public:
    template <class T>
    requires std::is_trivially_copyable_v<T>
    void raw(const T& v)
    {
        const auto* p = reinterpret_cast<const std::uint8_t*>(&v);
        bytes.insert(bytes.end(), p, p + sizeof v);
    }
    template <class T>
    requires std::is_arithmetic_v<T>
    void put(const T& v) { raw(v); }
    void put(bool v) { raw(static_cast<std::uint8_t>(v ? 1 : 0)); }
    void put(const Vec3& v) { put(v.x), put(v.y), put(v.z); }
    void put(const Quat& q) { put(q.w), put(q.x), put(q.y), put(q.z); }
    void put(const Mat3& m)
    {
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) put(m(r, c));
    }
    void put(std::string_view text)
    {
        raw(static_cast<std::uint32_t>(text.size()));
        bytes.insert(bytes.end(), text.begin(), text.end());
    }
    void put(const std::string& text) { put(std::string_view(text)); }
    void put(const Reals& list) { put_list(list); }
    void put(const Integers& list) { put_list(list); }
    void put(const Entries& entries)
    {
        raw(static_cast<std::uint32_t>(entries.size()));
        for (const Entry& e : entries)
        {
            put(e.name);
            std::visit([this](const auto& v) { put(Value(v)); }, e.value);
        }
    }
    void put(const Value& value)
    {
        put(type_name(value));
        std::visit(
            [this](const auto& v)
            {
                if constexpr (!std::is_same_v<std::decay_t<decltype(v)>, std::monostate>) put(v);
            },
            value);
    }
    /// Reserves space for a length that is known later.
    std::size_t reserve_length()
    {
        raw(std::uint64_t{0});
        return bytes.size();
    }
    void fill_length(std::size_t begin)
    {
        const std::uint64_t n = bytes.size() - begin;
        std::memcpy(bytes.data() + begin - sizeof n, &n, sizeof n);
    }

    std::vector<std::uint8_t> bytes;

private:
    template <class T>
    void put_list(const std::vector<T>& list)
    {
        raw(static_cast<std::uint32_t>(list.size()));
        for (const T& x : list) put(x);
    }
};

/// Reads until the data ends; from then on all values are empty and fine() is false.
class SectionReader
{
public:
    explicit SectionReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    bool fine() const { return fine_; }
    void fail() { fine_ = false; }
    std::size_t left() const { return bytes_.size() - at_; }
    template <class T>
    requires std::is_trivially_copyable_v<T> T raw()
    {
        T v{};
        if (!take(sizeof v)) return v;
        std::memcpy(&v, bytes_.data() + at_ - sizeof v, sizeof v);
        return v;
    }
    /// Reads a number of elements that take at least `least` bytes each.
    std::size_t count(std::size_t least)
    {
        const std::size_t n = raw<std::uint32_t>();
        if (n > left() / least) fine_ = false;
        return fine_ ? n : 0;
    }
    std::span<const std::uint8_t> part(std::uint64_t n)
    {
        if (n > left() || !take(static_cast<std::size_t>(n))) return fine_ = false, std::span<const std::uint8_t>();
        return bytes_.subspan(at_ - static_cast<std::size_t>(n), static_cast<std::size_t>(n));
    }

    template <class T>
    requires std::is_arithmetic_v<T>
    void get(T& v) { v = raw<T>(); }
    void get(bool& v)
    {
        const auto byte = raw<std::uint8_t>();
        if (byte > 1) fine_ = false;
        v = byte == 1;
    }
    void get(Vec3& v) { get(v.x), get(v.y), get(v.z); }
    void get(Quat& q) { get(q.w), get(q.x), get(q.y), get(q.z); }
    void get(Mat3& m)
    {
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) get(m(r, c));
    }
    void get(std::string& text)
    {
        const auto chars = part(raw<std::uint32_t>());
        text.assign(chars.begin(), chars.end());
    }
    void get(Reals& list) { get_list(list); }
    void get(Integers& list) { get_list(list); }
    void get(Entries& entries)
    {
        entries.resize(count(4 + 4));
        for (Entry& e : entries)
        {
            get(e.name);
            std::string type;
            get(type);
            if (type == "boolean")
                get(e.value.emplace<bool>());
            else if (type == "real")
                get(e.value.emplace<double>());
            else if (type == "text")
                get(e.value.emplace<std::string>());
            else
                fine_ = false;
        }
    }
    void get(Value& value)
    {
        std::string type;
        get(type);
        if (!fine_ || type == "none") return;
        fine_ = get_alternative<1>(type, value) && fine_;
    }

private:
    bool take(std::size_t n)
    {
        if (!fine_ || n > left()) return fine_ = false;
        at_ += n;
        return true;
    }
    template <class T>
    void get_list(std::vector<T>& list)
    {
        list.resize(count(sizeof(T)));
        for (T& x : list) get(x);
    }
    template <std::size_t I>
    bool get_alternative(const std::string& type, Value& value)
    {
        if constexpr (I < std::variant_size_v<Value>)
        {
            Value candidate(std::in_place_index<I>);
            if (type_name(candidate) != type) return get_alternative<I + 1>(type, value);
            get(std::get<I>(candidate));
            value = std::move(candidate);
            return true;
        }
        return false;
    }

    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
    bool fine_ = true;
};

/// The minimum number of bytes of one element.
template <class T>
constexpr std::size_t kLeast = sizeof(std::uint32_t);
template <>
constexpr std::size_t kLeast<bool> = 1;
template <>
constexpr std::size_t kLeast<std::int64_t> = 8;
template <>
constexpr std::size_t kLeast<double> = 8;
template <>
constexpr std::size_t kLeast<Vec3> = 24;
template <>
constexpr std::size_t kLeast<Quat> = 32;
template <>
constexpr std::size_t kLeast<Mat3> = 72;

template <class T>
bool read_data(std::span<const std::uint8_t> bytes, std::size_t rows, std::vector<T>& out)
{
    if (rows > bytes.size() / kLeast<T>) return false;
    SectionReader in(bytes);
    out.reserve(rows);
    for (std::size_t i = 0; i < rows && in.fine(); ++i)
    {
        T element{};
        in.get(element);
        out.push_back(std::move(element));
    }
    return in.fine() && in.left() == 0;
}

template <std::size_t I = 0>
bool read_column(const std::string& type, std::span<const std::uint8_t> bytes, std::size_t rows, ColumnData& out)
{
    if constexpr (I < std::variant_size_v<ColumnData>)
    {
        if (type != kColumnTypes[I]) return read_column<I + 1>(type, bytes, rows, out);
        return read_data(bytes, rows, out.emplace<I>());
    }
    return false;
}

Result<Section> read_section(SectionReader& in)
{
    Section out;
    in.get(out.name);
    out.rows = in.raw<std::uint32_t>();
    const std::size_t columns = in.count(4 + 4 + 8);
    for (std::size_t k = 0; k < columns && in.fine(); ++k)
    {
        NamedColumn column;
        std::string type;
        in.get(column.name), in.get(type);
        const auto data = in.part(in.raw<std::uint64_t>());
        if (!in.fine()) break;
        if (!read_column(type, data, out.rows, column.data))
            return reason("the snapshot's section '" + out.name + "', column '" + column.name + "' does not hold " +
                          std::to_string(out.rows) + " elements of type '" + type + "'");
        out.columns.push_back(std::move(column));
    }
    if (!in.fine()) return reason("the snapshot's section '" + out.name + "' is truncated");
    return out;
}

}  // namespace

const NamedColumn* Section::find(std::string_view column) const
{
    const auto at = std::find_if(columns.begin(), columns.end(), [&](const NamedColumn& c) { return c.name == column; });
    return at == columns.end() ? nullptr : &*at;
}

std::vector<std::uint8_t> write_sections(std::uint32_t version, std::span<const Section> sections)
{
    SectionWriter out;
    out.bytes.insert(out.bytes.end(), kSnapshotMagic.begin(), kSnapshotMagic.end());
    out.put(version);
    out.raw(std::uint64_t{0});
    for (const Section& s : sections)
    {
        out.put(s.name), out.put(static_cast<std::uint32_t>(s.rows)), out.put(static_cast<std::uint32_t>(s.columns.size()));
        for (const NamedColumn& c : s.columns)
        {
            out.put(c.name), out.put(kColumnTypes[c.data.index()]);
            const std::size_t begin = out.reserve_length();
            std::visit(
                [&](const auto& list)
                {
                    for (const auto& element : list) out.put(element);
                },
                c.data);
            out.fill_length(begin);
        }
    }
    const std::uint64_t length = out.bytes.size() + kEnding;
    std::memcpy(out.bytes.data() + kPreamble - sizeof length, &length, sizeof length);
    out.put(world::hash_bytes(kHashStart, out.bytes));
    return std::move(out.bytes);
}

Result<SectionFile> read_sections(std::span<const std::uint8_t> bytes, std::uint32_t newest)
{
    const std::size_t compared = std::min(bytes.size(), kSnapshotMagic.size());
    if (!std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(compared), kSnapshotMagic.begin(),
                    [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); }))
        return reason("this is not a pLab snapshot: it does not begin with '" + std::string(kSnapshotMagic) + "'");
    if (bytes.size() < kPreamble + kEnding)
        return reason("the snapshot is truncated: it has only " + std::to_string(bytes.size()) + " bytes");
    SectionFile out;
    SectionReader front(bytes.subspan(kSnapshotMagic.size()));
    out.version = front.raw<std::uint32_t>();
    const auto length = front.raw<std::uint64_t>();
    if (out.version < 1 || out.version > newest)
        return reason("the snapshot has format " + std::to_string(out.version) + ", this build reads 1 to " + std::to_string(newest));
    if (length != bytes.size())
        return reason("the snapshot should have " + std::to_string(length) + " bytes, but has " + std::to_string(bytes.size()));
    const auto body = bytes.first(bytes.size() - kEnding);
    if (SectionReader(bytes.last(kEnding)).raw<std::uint64_t>() != world::hash_bytes(kHashStart, body))
        return reason("the snapshot is damaged: its checksum does not match");
    SectionReader in(body.subspan(kPreamble));
    while (in.left() > 0)
    {
        auto section = read_section(in);
        if (!section) return section.errors();
        out.sections.push_back(section.take());
    }
    return out;
}

}  // namespace plab::simulation
