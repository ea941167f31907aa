// The values of the wire against plab.idl itself: the same members, of the same types, in the same order.
#include <doctest/doctest.h>

#include "idl/samples.h"

using namespace plab;

namespace
{

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

/// Names, types and number of the members are compared when idl/samples.h is compiled; their order is left.
template <class Value, class Sample>
void check_order(const Sample& sample)
{
    const void* last = &sample;
    visit_members(
        std::type_identity<Value>{},
        [&](const char* name, const auto& member)
        {
            CAPTURE(name);
            CHECK(static_cast<const void*>(&member) >= last);
            last = &member + 1;
        },
        sample);
}

template <class Value, class Sample>
void check(const std::string& name)
{
    CAPTURE(name);
    check_order<Value>(Sample{});
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
    check<wire::Gone, plab_v2_Gone>("Gone");
    check<wire::Image, plab_v2_Image>("Image");
}
