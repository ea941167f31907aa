/// Lists the members of a struct once. What copies it, sends it, compares it or prints it derives from that list.
///
///   struct Point { double x = 0, y = 0; };
///   PLAB_MEMBERS(Point, x, y)
///
///   for_each_member([](const char* name, double& member, const double& other) { member = other; }, a, b);
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#define PLAB_MEMBERS_PARENTHESES ()
#define PLAB_MEMBERS_RESCAN_2(...) PLAB_MEMBERS_RESCAN_1(PLAB_MEMBERS_RESCAN_1(PLAB_MEMBERS_RESCAN_1(__VA_ARGS__)))
#define PLAB_MEMBERS_RESCAN_1(...) PLAB_MEMBERS_RESCAN_0(PLAB_MEMBERS_RESCAN_0(PLAB_MEMBERS_RESCAN_0(__VA_ARGS__)))
#define PLAB_MEMBERS_RESCAN_0(...) PLAB_MEMBERS_ONCE(PLAB_MEMBERS_ONCE(PLAB_MEMBERS_ONCE(__VA_ARGS__)))
#define PLAB_MEMBERS_ONCE(...) __VA_ARGS__
#define PLAB_MEMBERS_FIRST(member, ...) \
    visit(#member, objects.member...);  \
    __VA_OPT__(PLAB_MEMBERS_NEXT PLAB_MEMBERS_PARENTHESES(__VA_ARGS__))
#define PLAB_MEMBERS_NEXT() PLAB_MEMBERS_FIRST

/// Stands behind the struct, in its namespace; at most 27 members.
#define PLAB_MEMBERS(Struct, ...)                                                                \
    template <class Visit, class... Objects>                                                     \
    constexpr void visit_members(std::type_identity<Struct>, Visit&& visit, Objects&... objects) \
    {                                                                                            \
        PLAB_MEMBERS_RESCAN_2(PLAB_MEMBERS_FIRST(__VA_ARGS__))                                   \
    }

namespace plab
{
namespace detail
{

struct Anything
{
    template <class T>
    operator T() const;  // NOLINT: never called, only converted by the compiler
};
struct Nothing
{
    template <class... Members>
    constexpr void operator()(const char*, Members&...) const
    {
    }
};

template <class T, std::size_t... I>
constexpr bool takes(std::index_sequence<I...>)
{
    return requires { T{(static_cast<void>(I), Anything{})...}; };
}

}  // namespace detail

/// The struct has a list of its members.
template <class T>
concept Described = requires
{
    visit_members(std::type_identity<T>{}, detail::Nothing{});
};

/// The number of fields of an aggregate: the largest number of values that can initialize it. The elements of a C array count.
template <class T, std::size_t Most = 44>
constexpr std::size_t field_count()
{
    static_assert(std::is_aggregate_v<T>);
    if constexpr (detail::takes<T>(std::make_index_sequence<Most>{}))
        return Most;
    else
        return field_count<T, Most - 1>();
}

template <Described T>
constexpr std::size_t member_count()
{
    std::size_t count = 0;
    visit_members(std::type_identity<T>{}, [&](const char*) { ++count; });
    return count;
}

/// Calls visit(name, member of `object`, member of each other object ...) for each listed member, in their order. The others
/// are of any types that have members of these names.
template <class T, class Visit, class... Others>
constexpr void for_each_member(Visit&& visit, T& object, Others&... others)
{
    using Struct = std::remove_const_t<T>;
    static_assert(member_count<Struct>() == field_count<Struct>(), "a member is missing in its list");
    visit_members(std::type_identity<Struct>{}, visit, object, others...);
}

/// All members are equal.
template <Described T>
constexpr bool same_members(const T& a, const T& b)
{
    bool same = true;
    for_each_member([&](const char*, const auto& x, const auto& y) { same = same && x == y; }, a, b);
    return same;
}

}  // namespace plab
