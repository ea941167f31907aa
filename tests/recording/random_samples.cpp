#include "random_samples.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

namespace plab::test
{
namespace
{

using Kind = link::DynamicType::Kind;
using recording::Bytes;

class SampleMaker
{
public:
    explicit SampleMaker(std::mt19937_64& random) : random_(&random) {}

    void put(const link::DynamicType& type)
    {
        switch (type.kind)
        {
            case Kind::Struct:
                for (const link::DynamicMember& member : type.members) put(*member.type);
                break;
            case Kind::Sequence:
                put_sequence(type);
                break;
            case Kind::Array:
                for (std::size_t i = 0; i < product(type.dimensions); ++i) put(*type.element);
                break;
            case Kind::String:
                put_string();
                break;
            case Kind::Enum:
                number(static_cast<std::uint32_t>(type.literals.at(pick(type.literals.size())).first));
                break;
            default:
                put_scalar(type.kind);
        }
    }
    Bytes take() { return std::move(bytes_); }

private:
    void put_scalar(Kind kind)
    {
        const std::uint64_t bits = (*random_)();
        switch (kind)
        {
            case Kind::Boolean:
                return number(static_cast<std::uint8_t>(bits & 1));
            case Kind::Octet:
            case Kind::Char:
                return number(static_cast<std::uint8_t>(bits & 0x7f));
            case Kind::Int16:
            case Kind::Uint16:
                return number(static_cast<std::uint16_t>(bits));
            case Kind::Int32:
            case Kind::Uint32:
                return number(static_cast<std::uint32_t>(bits));
            case Kind::Float32:
                return number(static_cast<float>(real()));
            case Kind::Float64:
                return number(real());
            default:
                return number(bits);
        }
    }
    void put_sequence(const link::DynamicType& type)
    {
        const std::size_t n = pick(5);
        number(static_cast<std::uint32_t>(n));
        for (std::size_t i = 0; i < n; ++i) put(*type.element);
    }
    void put_string()
    {
        constexpr std::array kTexts{"", "a", "states of \"three\" wheels", "r\xc3\xa4umlich \xe2\x88\x82/\xe2\x88\x82t", "line\nline\ttab"};
        const std::string text = kTexts[pick(kTexts.size())];
        number(static_cast<std::uint32_t>(text.size() + 1));
        bytes_.insert(bytes_.end(), text.c_str(), text.c_str() + text.size() + 1);
    }
    /// Little-endian; aligned from where the encapsulation ends.
    template <class T>
    void number(T v)
    {
        while ((bytes_.size() - 4) % sizeof v != 0) bytes_.push_back(0);
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof v);
        std::memcpy(bytes_.data() + at, &v, sizeof v);
    }
    double real()
    {
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        constexpr std::array kSpecial{0.0, -0.0, kInfinity, -kInfinity, std::numeric_limits<double>::denorm_min(), 0.1};
        if (pick(8) == 0) return kSpecial[pick(kSpecial.size())];
        const double fraction = static_cast<double>(static_cast<std::int64_t>((*random_)())) * 0x1p-63;
        return std::ldexp(fraction, static_cast<int>(pick(200)) - 100);
    }
    std::size_t pick(std::size_t n) { return (*random_)() % n; }
    static std::size_t product(const std::vector<std::uint32_t>& dimensions)
    {
        std::size_t out = 1;
        for (const std::uint32_t n : dimensions) out *= n;
        return out;
    }

    std::mt19937_64* random_;
    Bytes bytes_{0, 1, 0, 0};
};

}  // namespace

recording::Bytes random_sample(const link::DynamicType& type, std::mt19937_64& random)
{
    SampleMaker maker(random);
    maker.put(type);
    return maker.take();
}

}  // namespace plab::test
