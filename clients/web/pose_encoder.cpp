#include "web/pose_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace plab::web
{
namespace
{

constexpr std::uint8_t kKey = 1, kDelta = 2;
constexpr std::int64_t kLongestKey = 900'000'000;  ///< ns for which a key frame serves
constexpr std::size_t kExactNumbers = 13;

std::size_t padded(std::size_t bytes) { return (bytes + 7) / 8 * 8; }

/// Writes numbers one behind the other, in the order of bytes of this machine: x86-64 and browsers are little-endian.
class Writer
{
public:
    explicit Writer(unsigned char* at) : begin_(at), at_(at) {}
    template <class T>
    void put(T value)
    {
        std::memcpy(at_, &value, sizeof value);
        at_ += sizeof value;
    }
    template <class T>
    void put_all(const std::vector<T>& values)
    {
        if (!values.empty()) std::memcpy(at_, values.data(), values.size() * sizeof(T));
        at_ += values.size() * sizeof(T);
    }
    void align() { at_ = begin_ + padded(static_cast<std::size_t>(at_ - begin_)); }

private:
    unsigned char *begin_, *at_;
};

std::int16_t to_short(double value) { return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0, 1.0) * 32767)); }

double finite(double value) { return std::isfinite(value) ? value : 0; }

std::vector<const plab_v2_BodyState*> chosen(const plab_v2_Frame& frame, const std::set<std::uint32_t>& exact)
{
    std::vector<const plab_v2_BodyState*> out;
    for (std::uint32_t i = 0; i < frame.bodies._length && out.size() < exact.size(); ++i)
        if (exact.contains(frame.bodies._buffer[i].handle)) out.push_back(&frame.bodies._buffer[i]);
    return out;
}

void put_exact(Writer& out, const plab_v2_BodyState& b)
{
    for (const double value :
         {b.position.x, b.position.y, b.position.z, b.orientation.w, b.orientation.x, b.orientation.y, b.orientation.z, b.linear_velocity.x,
          b.linear_velocity.y, b.linear_velocity.z, b.angular_velocity.x, b.angular_velocity.y, b.angular_velocity.z})
        out.put(value);
}

}  // namespace

void PoseEncoder::read(const plab_v2_Frame& frame)
{
    now_.names.resize(frame.bodies._length), now_.rows.resize(frame.bodies._length);
    for (std::uint32_t i = 0; i < frame.bodies._length; ++i)
    {
        const plab_v2_BodyState& b = frame.bodies._buffer[i];
        now_.names[i] = b.handle;
        const auto number = [](double v) { return static_cast<float>(finite(v)); };
        now_.rows[i].position = {number(b.position.x), number(b.position.y), number(b.position.z)};
        now_.rows[i].rotation = {to_short(finite(b.orientation.w)), to_short(finite(b.orientation.x)), to_short(finite(b.orientation.y)),
                                 to_short(finite(b.orientation.z))};
    }
    now_.shaft_names.resize(frame.shafts._length), now_.shafts.resize(2 * std::size_t{frame.shafts._length});
    for (std::uint32_t i = 0; i < frame.shafts._length; ++i)
    {
        now_.shaft_names[i] = frame.shafts._buffer[i].handle;
        now_.shafts[2 * std::size_t{i}] = frame.shafts._buffer[i].angle;
        now_.shafts[2 * std::size_t{i} + 1] = frame.shafts._buffer[i].speed;
    }
}

bool PoseEncoder::fits_key(const plab_v2_Frame& frame) const
{
    return key_ != nullptr && frame.run == run_ && frame.revision == revision_ && frame.stamp_ns - key_stamp_ < kLongestKey &&
           now_.names == key_rows_.names && now_.shaft_names == key_rows_.shaft_names;
}

void PoseEncoder::find_changes()
{
    delta_.names.clear(), delta_.rows.clear(), delta_.shaft_names.clear(), delta_.shafts.clear();
    for (std::uint32_t i = 0; i < now_.rows.size(); ++i)
        if (now_.rows[i] != key_rows_.rows[i]) delta_.names.push_back(i), delta_.rows.push_back(now_.rows[i]);
    for (std::uint32_t i = 0; i < now_.shaft_names.size(); ++i)
    {
        const double *const shaft = &now_.shafts[2 * std::size_t{i}], *const before = &key_rows_.shafts[2 * std::size_t{i}];
        if (shaft[0] != before[0] || shaft[1] != before[1])
            delta_.shaft_names.push_back(i), delta_.shafts.insert(delta_.shafts.end(), {shaft[0], shaft[1]});
    }
}

MessagePtr PoseEncoder::message_of(std::uint8_t kind, const Part& part, const plab_v2_Frame& frame,
                                   const std::set<std::uint32_t>& exact) const
{
    static_assert(sizeof(Row) == 20);
    constexpr std::size_t kHead = 56;
    const auto rows = chosen(frame, exact);
    const std::size_t shafts_at =
        padded(kHead + part.names.size() * (sizeof(std::uint32_t) + sizeof(Row)) + part.shaft_names.size() * sizeof(std::uint32_t));
    const std::size_t exact_at = padded(shafts_at + part.shafts.size() * sizeof(double) + rows.size() * sizeof(std::uint32_t));
    auto out = std::make_shared<Message>(Message::binary(exact_at + rows.size() * kExactNumbers * sizeof(double)));
    Writer write(out->content());
    write.put(kind), write.put(std::uint8_t{1}), write.put(std::uint16_t{0}), write.put(static_cast<std::uint32_t>(frame.run));
    write.put(frame.time), write.put(static_cast<double>(frame.stamp_ns) * 1e-6), write.put(static_cast<double>(frame.step));
    write.put(static_cast<std::uint32_t>(number_)), write.put(static_cast<std::uint32_t>(key_number_));
    write.put(static_cast<std::uint32_t>(frame.revision)), write.put(static_cast<std::uint32_t>(part.names.size()));
    write.put(static_cast<std::uint32_t>(part.shaft_names.size())), write.put(static_cast<std::uint32_t>(rows.size()));
    write.put_all(part.names);
    for (const Row& row : part.rows) write.put(row.position);
    for (const Row& row : part.rows) write.put(row.rotation);
    write.put_all(part.shaft_names), write.align(), write.put_all(part.shafts);
    for (const plab_v2_BodyState* row : rows) write.put(row->handle);
    write.align();
    for (const plab_v2_BodyState* row : rows) put_exact(write, *row);
    return out;
}

Poses PoseEncoder::encode(const plab_v2_Frame& frame, const std::set<std::uint32_t>& exact)
{
    read(frame);
    ++number_;
    if (fits_key(frame))
    {
        find_changes();
        if (2 * delta_.names.size() <= now_.names.size() || now_.names.size() < 32)
            return {key_number_, key_, message_of(kDelta, delta_, frame, exact)};
    }
    key_rows_ = now_;
    key_number_ = number_, run_ = frame.run, revision_ = frame.revision, key_stamp_ = frame.stamp_ns;
    key_ = message_of(kKey, key_rows_, frame, exact);
    return {key_number_, key_, nullptr};
}

}  // namespace plab::web
