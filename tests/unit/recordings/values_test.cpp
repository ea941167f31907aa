// The values of the wire against plab.idl itself: the same members, of the same types, in the same order.
#include <doctest/doctest.h>

#include "control/recordings/schema.h"
#include "idl/recording/plab_idl_text.h"
#include "idl/samples.h"

using namespace plab;
using link::DynamicType;

namespace
{

template <class T>
constexpr DynamicType::Kind kind_of()
{
    using Kind = DynamicType::Kind;
    if constexpr (std::is_same_v<T, bool>) return Kind::Boolean;
    if constexpr (std::is_same_v<T, std::uint8_t>) return Kind::Octet;
    if constexpr (std::is_same_v<T, std::int32_t>) return Kind::Int32;
    if constexpr (std::is_same_v<T, std::int64_t>) return Kind::Int64;
    if constexpr (std::is_same_v<T, std::uint32_t>) return Kind::Uint32;
    if constexpr (std::is_same_v<T, std::uint64_t>) return Kind::Uint64;
    if constexpr (std::is_same_v<T, double>) return Kind::Float64;
    if constexpr (std::is_same_v<T, std::string>) return Kind::String;
    if constexpr (std::is_same_v<T, wire::ClientId>) return Kind::Array;
    return Kind::Struct;
}

template <class T>
struct IsVector : std::false_type
{
};
template <class T>
struct IsVector<std::vector<T>> : std::true_type
{
};

/// Fills every member with a value of its own; texts and sequences of every length.
struct Filler
{
    std::uint64_t next = 1;

    template <class T>
    void fill(T& value)
    {
        if constexpr (Described<T>)
            for_each_member([this](const char*, auto& member) { this->fill(member); }, value);
        else if constexpr (std::is_same_v<T, std::string>)
            value = "text " + std::to_string(next++);
        else if constexpr (std::is_same_v<T, bool>)
            value = true;
        else if constexpr (std::is_same_v<T, wire::ClientId>)
            for (std::uint8_t& byte : value) byte = static_cast<std::uint8_t>(next++);
        else if constexpr (IsVector<T>::value)
            for (value.resize(1 + next % 3); auto& element : value) fill(element);
        else
            value = static_cast<T>(next++);
    }
};

template <class T>
void compare(const DynamicType& idl, const std::string& place)
{
    CAPTURE(place);
    if constexpr (IsVector<T>::value)
    {
        REQUIRE(idl.kind == DynamicType::Kind::Sequence);
        compare<typename T::value_type>(*idl.element, place + "[]");
    }
    else
    {
        REQUIRE(idl.kind == kind_of<T>());
        if constexpr (Described<T>)
        {
            REQUIRE(idl.members.size() == member_count<T>());
            std::size_t i = 0;
            T value;
            for_each_member(
                [&]<class Member>(const char* name, const Member&)
                {
                    CHECK(idl.members[i].name == name);
                    compare<Member>(*idl.members[i].type, place + "." + name);
                    ++i;
                },
                value);
        }
    }
}

template <class Value, class Sample>
void check(const std::string& name)
{
    CAPTURE(name);
    const auto idl = recordings::type_in(recording::kPlabIdl, "plab::v2::" + name);
    REQUIRE(idl);
    compare<Value>(**idl, name);

    Value value;
    Filler{}.fill(value);
    wire::SampleView<Sample> view;
    const Sample& sample = view.of(value);
    CHECK(wire::value_of<Value>(sample) == value);
    CHECK_FALSE(wire::value_of<Value>(sample) == Value{});
    // The next sample of the same view: longer, then shorter again.
    Value longer = value;
    Filler{1000}.fill(longer);
    CHECK(wire::value_of<Value>(view.of(longer)) == longer);
    CHECK(wire::value_of<Value>(view.of(value)) == value);
    CHECK(wire::value_of<Value>(view.of(Value{})) == Value{});
}

}  // namespace

TEST_CASE("each value has the members of its type in plab.idl, and survives as a sample")
{
    check<wire::Server, plab_v2_Server>("Server");
    check<wire::Scene, plab_v2_Scene>("Scene");
    check<wire::SceneObject, plab_v2_SceneObject>("SceneObject");
    check<wire::Shape, plab_v2_Shape>("Shape");
    check<wire::Interaction, plab_v2_Interaction>("Interaction");
    check<wire::Type, plab_v2_Type>("Type");
    check<wire::Frame, plab_v2_Frame>("Frame");
    check<wire::Collisions, plab_v2_Collisions>("Collisions");
    check<wire::Events, plab_v2_Events>("Events");
    check<wire::Metrics, plab_v2_Metrics>("Metrics");
    check<wire::Request, plab_v2_Request>("Request");
    check<wire::Reply, plab_v2_Reply>("Reply");
    check<wire::Journal, plab_v2_Journal>("Journal");
    check<wire::Hashes, plab_v2_Hashes>("Hashes");
    check<wire::Snapshot, plab_v2_Snapshot>("Snapshot");
    check<wire::Image, plab_v2_Image>("Image");
}
