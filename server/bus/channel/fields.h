/// Visits the fields of a plain struct one after the other, so that no separate list of fields has to be maintained.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace plab::bus
{
namespace detail
{

struct Anything
{
    template <class T>
    operator T() const;  // NOLINT: never called, only converted by the compiler
};

template <class T, std::size_t... I>
constexpr bool takes(std::index_sequence<I...>)
{
    return requires { T{(static_cast<void>(I), Anything{})...}; };
}

}  // namespace detail

/// The number of fields of an aggregate: the largest number of values that can initialize it.
template <class T, std::size_t Most = 24>
constexpr std::size_t field_count()
{
    static_assert(std::is_aggregate_v<T>);
    if constexpr (detail::takes<T>(std::make_index_sequence<Most>{}))
    {
        static_assert(!detail::takes<T>(std::make_index_sequence<Most + 1>{}), "for_each_field() needs more lines");
        return Most;
    }
    else
        return field_count<T, Most - 1>();
}

/// Calls `f` with each field, in order of declaration. T is an aggregate, const or not.
template <class T, class F>
constexpr void for_each_field(T& t, F&& f)
{
    const auto all = [&](auto&... field) { (f(field), ...); };
    constexpr std::size_t n = field_count<std::remove_const_t<T>>();
    if constexpr (n == 1)
    {
        auto& [a] = t;
        all(a);
    }
    else if constexpr (n == 2)
    {
        auto& [a, b] = t;
        all(a, b);
    }
    else if constexpr (n == 3)
    {
        auto& [a, b, c] = t;
        all(a, b, c);
    }
    else if constexpr (n == 4)
    {
        auto& [a, b, c, d] = t;
        all(a, b, c, d);
    }
    else if constexpr (n == 5)
    {
        auto& [a, b, c, d, e] = t;
        all(a, b, c, d, e);
    }
    else if constexpr (n == 6)
    {
        auto& [a, b, c, d, e, g] = t;
        all(a, b, c, d, e, g);
    }
    else if constexpr (n == 7)
    {
        auto& [a, b, c, d, e, g, h] = t;
        all(a, b, c, d, e, g, h);
    }
    else if constexpr (n == 8)
    {
        auto& [a, b, c, d, e, g, h, i] = t;
        all(a, b, c, d, e, g, h, i);
    }
    else if constexpr (n == 9)
    {
        auto& [a, b, c, d, e, g, h, i, j] = t;
        all(a, b, c, d, e, g, h, i, j);
    }
    else if constexpr (n == 10)
    {
        auto& [a, b, c, d, e, g, h, i, j, k] = t;
        all(a, b, c, d, e, g, h, i, j, k);
    }
    else if constexpr (n == 11)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l] = t;
        all(a, b, c, d, e, g, h, i, j, k, l);
    }
    else if constexpr (n == 12)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m);
    }
    else if constexpr (n == 13)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o);
    }
    else if constexpr (n == 14)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o, p] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o, p);
    }
    else if constexpr (n == 15)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o, p, q] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o, p, q);
    }
    else if constexpr (n == 16)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r);
    }
    else if constexpr (n == 17)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s);
    }
    else if constexpr (n == 18)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u);
    }
    else if constexpr (n == 19)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v);
    }
    else if constexpr (n == 20)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w);
    }
    else if constexpr (n == 21)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x);
    }
    else if constexpr (n == 22)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x, y] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x, y);
    }
    else if constexpr (n == 23)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x, y, z] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x, y, z);
    }
    else if constexpr (n == 24)
    {
        auto& [a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x, y, z, A] = t;
        all(a, b, c, d, e, g, h, i, j, k, l, m, o, p, q, r, s, u, v, w, x, y, z, A);
    }
}

}  // namespace plab::bus
